// A batch is done when both loops have been gone through for the left eye and then for the right one (slats_rules.md).
//
// Registers on entry besides those of parameters.s: r19 where command words of the right eye go, r21 its parameter block; r18 and r20 are
// those of the left eye. On return: r18 and r19 behind the last command of either eye.

// ---- stack frame
BATCH   = 464       // triangles of the batch
TURN    = 468       // 0 while the left eye's commands are made, 1 while the right eye's are

        .macro  lefteye
        st.l    r0, TURN(r2)
        .endm
        .macro  batchnoted
        st.l    r31, BATCH(r2)
        .endm
        .macro  nexteye
        mov     r18, r7
        mov     r19, r18
        mov     r7, r19
        mov     r20, r7
        mov     r21, r20
        mov     r7, r21
        ld.l    TURN(r2), r8
        ld.l    BATCH(r2), r31
        xor     1, r8, r8
        st.l    r8, TURN(r2)
        btne    r0, r8, righteye
        .endm
