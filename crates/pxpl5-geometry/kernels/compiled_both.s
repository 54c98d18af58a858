// The main loop for both eyes (slats_rules.md).
//
// Registers on entry besides those of parameters.s: r19 where command words of the right eye go, r21 its parameter block; r18 and r20 are
// those of the left eye. On return: r18 and r19 behind the last command of either eye.

// ---- stack frame: the structures of the right eye's corners lie behind those of the left eye, which have the surface of both
BEYOND  = 4       // 2 where a corner is outside of the left eye's guard band, and 1 of the right eye's
EYE     = 144     // from the structures of one eye to those of the other
PLACES  = 384     // the structures of an eye
SURFACES = 388    // where the surface is, counted from them

        .macro  firstcorner to
        ld.l    PLACES(r2), \to
        nop
        .endm
        .macro  surfaceof k
        ld.l    SURFACES(r2), r10
        nop
        adds    8*\k, r10, r10
        .endm

// the other eye's commands and parameter block
        .macro  othereye
        mov     r18, r7
        mov     r19, r18
        mov     r7, r19
        mov     r20, r7
        mov     r21, r20
        mov     r7, r21
        .endm

        .align  32
start:  st.l    r1, SAVE(r2)
next:   mov     r16, r5
        adds    CORNERS, r2, r6
        mov     3, r4
        mov     r0, r23
each:   call    corner
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, each
        st.l    r23, BEYOND(r2)
        surfaces
        adds    CORNERS, r2, r7
        st.l    r7, PLACES(r2)
        mov     C_SURFACE, r7
        st.l    r7, SURFACES(r2)
        mov     2, r3
eye:    ld.l    BEYOND(r2), r7
        nop
        and     r3, r7, r7
        btne    r0, r7, clip
        set_up  done
done:   othereye
        ld.l    PLACES(r2), r7
        ld.l    SURFACES(r2), r8
        adds    EYE, r7, r7
        st.l    r7, PLACES(r2)
        adds    -EYE, r8, r8
        st.l    r8, SURFACES(r2)
        adds    -1, r3, r3
        btne    r0, r3, eye
        adds    -1, r17, r17
        adds    LIST_STEP, r16, r16
        btne    r0, r17, next
        ld.l    SAVE(r2), r1
        nop
        bri     r1
        nop
clip:   ld.l    P_CLIPPER(r20), r6          // not wholly inside the guard band
        nop
        calli   r6
        nop
        br      done
        nop

// ---- corner: vertex at r5 to the structures of both eyes, of which that of the left one is at r6, and r6 to the next; r23 gets the eyes
// of whose guard band it is outside
corner: fld.l   0(r5), f4
        fld.l   4(r5), f5
        fld.l   8(r5), f6
        mov     2, r3
view:   fld.l   P_ORIGIN(r20), f8
        fld.l   P_ORIGIN+4(r20), f9
        fsub.ss f4, f8, f16                 // relative to the eye
        fld.l   P_ORIGIN+8(r20), f10
        fsub.ss f5, f9, f17
        fld.l   P_ROWS(r20), f8
        fld.l   P_ROWS+4(r20), f9
        fsub.ss f6, f10, f18
        clipped 0, f20
        clipped 1, f21
        clipped 2, f22
        clipped 3, f23
        guarded
        placed
        fsub.dd f12, f10, f12
        fst.d   f12, C_DEPTH(r6)
turn:   mov     r20, r7
        mov     r21, r20
        mov     r7, r21
        adds    EYE, r6, r6
        adds    -1, r3, r3
        btne    r0, r3, view
        bri     r1
        adds    C_BYTES-2*EYE, r6, r6
beyond: br      turn
        or      r3, r23, r23
