// One triangle after another, as a good compiler of about 1990 would give a plain program in C: functions that are called, loops that
// stay loops, locals in registers, scalar floating point with loads in its shadow. The rules were written down before the code
// (compiled_rules.md).
//
// The arithmetic and its order are those of the native transform and set-up.

// ---- stack frame, further up as in setup_scalar.s
SAVE   = 0        // return address

        .macro  firstcorner to
        adds    CORNERS, r2, \to
        .endm
        .macro  secondcorner to
        adds    C_BYTES, r7, \to
        .endm

// Planes of triangles that are not clipped are taken as they come.
        .macro  steep
        .endm

        .align  32
start:  st.l    r1, SAVE(r2)
        counted
next:   passover_straight
        mov     r16, r5
        adds    CORNERS, r2, r6
        mov     3, r4
each:   call    corner
        adds    -1, r4, r4
        bte     r0, r7, clip
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, each
        surfaces
        set_up  done
done:   adds    -1, r17, r17
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

// ---- corner: vertex at r5 to the structure at r6, and r6 to the next; r7 is 0 if it is outside of the guard band

corner: projected
        guarded
        placed
        fld.l   NORMAL(r5), f20
        fsub.dd f12, f10, f12
        fld.l   NORMAL+4(r5), f21
        fst.d   f12, C_DEPTH(r6)
        fmul.ss f16, f20, f16               // how far the normal turns away
        fld.l   NORMAL+8(r5), f22
        fmul.ss f17, f21, f17
        fadd.ss f16, f17, f16
        fmul.ss f18, f22, f18
        fadd.ss f16, f18, f16
        fst.l   f16, C_AWAY(r6)
        adds    C_BYTES, r6, r6
        bri     r1
        mov     1, r7
beyond: bri    r1
        mov     r0, r7

