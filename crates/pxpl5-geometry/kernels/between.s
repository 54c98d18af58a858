// Triangles between two views: their commands for a strip, which are kept with their boxes (pphigs's kernels/between_rules.md).
//
// In: as a kernel that keeps boxes; r21 records of the triangles, r22 and r23 the least and the greatest y of what is near the strip, 1/16 px
// of the frame; r24 not 0 where they are interpolated in the view; r25 and r26 the part of the way as a double.

// ---- stack frame, behind the corners
NEAR_TOP = 240
NEAR_BOTTOM = 244
PART    = 248
IN_VIEW = 256

        .align  32
start:  st.l    r1, SAVE(r2)
        st.l    r22, NEAR_TOP(r2)
        st.l    r23, NEAR_BOTTOM(r2)
        st.l    r24, IN_VIEW(r2)
        st.l    r25, PART(r2)
        st.l    r26, PART+4(r2)
next:   ld.l    E_INSIDE(r21), r5
        ld.l    E_TOP(r21), r6
        mov     3, r4
        bte     r0, r5, whole               // not on the screen in both
        ld.l    NEAR_BOTTOM(r2), r7
        ld.l    E_BOTTOM(r21), r8
        subs    r7, r6, r0
        bc      done                        // below the strip
        ld.l    NEAR_TOP(r2), r7
        ld.l    IN_VIEW(r2), r5
        subs    r8, r7, r0
        bc      done                        // above it
        btne    r0, r5, whole
        mov     r16, r5
        adds    CORNERS, r2, r6
        adds    E_CORNERS, r21, r10
screen: call    between
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, screen
        br      lit
        nop
whole:  mov     r16, r5
        adds    CORNERS, r2, r6
each:   call    corner
        adds    -1, r4, r4
        bte     r0, r7, clip
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, each
lit:    surfaces
        set_up  done
done:   adds    -1, r17, r17
        adds    LIST_STEP, r16, r16
        adds    E_BYTES, r21, r21
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

// f18 = the whole number nearest to the part f30 of the way from f12 to f14, up between two; 1.5 * 2^52 in f26, 1/2 in f28
        .macro  nearest
        fsub.dd f14, f12, f14
        fmul.dd f14, f30, f14
        fadd.dd f12, f14, f12
        fadd.dd f12, f28, f12
        fadd.dd f12, f26, f18
        fsub.dd f18, f26, f18
        pfgt.dd f18, f12, f0
        bnc     floor\@
        fsub.dd f18, f28, f18
        fsub.dd f18, f28, f18
floor\@:
        .endm

// coordinate `at` of the corner at r10 to `to` of the structure at r6
        .macro  coordinate at, to
        fld.l   \at(r10), f8
        fld.l   E_VIEW+\at(r10), f9
        fmov.sd f8, f12
        fmov.sd f9, f14
        nearest
        fmov.ds f18, f8
        fst.l   f8, \to(r6)
        .endm

// ---- between: vertex at r5 and its places at r10 to the structure at r6, and r6 and r10 to the next ones
between: fld.l  0(r5), f16
        fld.l   P_ORIGIN(r20), f8
        fld.l   4(r5), f17
        fld.l   P_ORIGIN+4(r20), f9
        fsub.ss f16, f8, f16
        fld.l   8(r5), f18
        fld.l   P_ORIGIN+8(r20), f10
        fsub.ss f17, f9, f17
        fld.l   NORMAL(r5), f20
        fsub.ss f18, f10, f18
        fld.l   NORMAL+4(r5), f21
        fmul.ss f16, f20, f16               // how far the normal turns away
        fld.l   NORMAL+8(r5), f22
        fmul.ss f17, f21, f17
        fadd.ss f16, f17, f16
        fld.d   P_ROUND(r20), f26
        fmul.ss f18, f22, f18
        fld.d   P_HALF(r20), f28
        fadd.ss f16, f18, f16
        fld.d   PART(r2), f30
        fst.l   f16, C_AWAY(r6)
        coordinate 0, C_X
        coordinate 4, C_Y
        fld.d   E_DEPTH(r10), f12
        fld.d   E_VIEW+E_DEPTH(r10), f14
        nearest
        orh     0x41EF, r0, r7              // 2^32 - 1
        or      0xFFFF, r7, r7
        ixfr    r7, f21
        orh     0xFFE0, r0, r7
        ixfr    r7, f20
        pfgt.dd f18, f0, f0
        bc      above
        fmov.dd f0, f18
above:  pfgt.dd f18, f20, f0
        bnc     below
        fmov.dd f20, f18
below:  fst.d   f18, C_DEPTH(r6)
        adds    E_CORNER, r10, r10
        bri     r1
        adds    C_BYTES, r6, r6
