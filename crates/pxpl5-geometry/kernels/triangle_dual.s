// One Gouraud triangle after another in dual-instruction mode: a floating-point and a core operation in every clock.
// Fits the 4 KB instruction cache together with the bins.
//
// Every pair is two lines: the floating-point half, then the core half indented further. The comment says where a
// step begins; the pairs of several steps overlap. Three corners go through the pipes side by side, then three edges,
// then the planes of depth and colours. Results leave a pipe into the destination of a later operation of the same
// unit, so the register at the end of a line belongs to an earlier step. Arithmetic and its order are those of the
// native transform and set-up; only 1 / w and 16 / area are formed by Newton steps (in double precision) instead of
// divisions.

// ---- stack frame. A corner: x, y (double), x and y as biased integers, (8 free), then depth, red, green, blue as
// words under the high word of 2^52, so that each reads as a double.
AREA    = 192       // twice the area, double
LOW     = 200       // least x, y of the corners, biased by 0x4B400000
HIGH    = 208       // 0x97000000 less the greatest x, y, biased
SCRATCH = 216       // clip coordinates x, y, z: 16 bytes each
DEPTH   = 328       // three times 16 bytes
BOX     = 288       // low x, high x, low y, high y
REFX    = 304       // pixel of reference under the high word of 2^52
REFY    = 312
SAVE    = 320       // return address
KEEP    = 376       // pixel of reference x, y; corner 0 to it x, y (double)

        .macro  edgeword k, n, to
        ld.l    8+16*\k+4*\n(r18), \to
        .endm

        .align  32
start:  st.l    r1, SAVE(r2)
        orh     0x4330, r0, r4              // high word of 2^52
        st.l    r4, REFX+4(r2)
        st.l    r4, REFY+4(r2)
        .macro  high n
        st.l    r4, 64*\n+36(r2)
        st.l    r4, 64*\n+44(r2)
        st.l    r4, 64*\n+52(r2)
        st.l    r4, 64*\n+60(r2)
        .endm
        high    0
        high    1
        high    2
        .align  8

// ---- corners: transform, guard band, 1 / w, screen, depth, bounding box, area
next:   d.fnop
            nop
        d.fnop
            fld.q   0(r16), f4            // corners
        d.fnop
            fld.q   16(r16), f8
        d.fnop
            fld.q   32(r16), f12
        d.fnop
            fld.q   P_ORIGIN(r20), f16    // eye
        d.fnop
            fld.l   P_ROWS+48(r20), f2
        d.fnop
            fld.l   P_ROWS+52(r20), f3
        d.pfsub.ss f4, f16, f0            // relative to the eye, x
            ld.l    12(r16), r4           // colour of a corner
        d.pfsub.ss f8, f16, f0
            nop
        d.pfsub.ss f12, f16, f0
            and     255, r4, r5
        d.pfsub.ss f5, f17, f20           // relative to the eye, y
            nop
        d.pfsub.ss f9, f17, f21
            fld.l   P_ROWS+56(r20), f22
        d.pfsub.ss f13, f17, f23
            nop
        d.pfsub.ss f6, f18, f24           // relative to the eye, z
            shl     12, r5, r6
        d.pfsub.ss f10, f18, f25
            nop
        d.pfsub.ss f14, f18, f4
            nop
        d.pfmul.ss f2, f20, f0            // row w, product 0
            nop
        d.pfmul.ss f2, f21, f0
            fld.l   P_ROWS+60(r20), f5
        d.pfmul.ss f2, f23, f0
            adds    2048, r6, r7
        d.pfmul.ss f3, f24, f2            // row w, product 1
            nop
        d.pfmul.ss f3, f25, f6
            fld.q   P_GUARD(r20), f8
        d.pfmul.ss f3, f4, f12
            fld.l   P_ROWS+0(r20), f7
        d.pfadd.ss f0, f0, f3
            nop
        d.pfmul.ss f22, f3, f13           // row w, product 2
            nop
        d.pfadd.ss f2, f13, f14
            nop
        d.pfmul.ss f22, f14, f2
            nop
        d.pfadd.ss f6, f2, f13
            nop
        d.pfmul.ss f22, f13, f2
            st.l    r7, 40(r2)
        d.pfadd.ss f12, f2, f0
            nop
        d.pfmul.ss f7, f20, f6            // row x, product 0
            fld.l   P_ROWS+4(r20), f2
        d.pfadd.ss f12, f6, f12
            nop
        d.pfmul.ss f7, f21, f6
            shr     8, r4, r8
        d.pfadd.ss f12, f6, f12
            nop
        d.pfmul.ss f7, f23, f6
            nop
        d.pfadd.ss f7, f6, f7
            nop
        d.pfadd.ss f15, f5, f15           // coordinate w
            fld.l   P_ROWS+8(r20), f12
        d.pfadd.ss f15, f5, f15
            nop
        d.pfadd.ss f15, f5, f15
            nop
        d.pfmul.ss f2, f24, f15           // row x, product 1
            fld.l   P_ROWS+12(r20), f5
        d.pfmul.ss f2, f25, f22
            and     255, r8, r9
        d.pfmul.ss f2, f4, f6
            shl     12, r9, r10
        d.pfmul.ss f12, f3, f2            // row x, product 2
            nop
        d.pfadd.ss f15, f2, f7
            nop
        d.pfmul.ss f12, f14, f2
            nop
        d.pfadd.ss f22, f2, f15
            nop
        d.pfmul.ss f12, f13, f2
            nop
        d.pfadd.ss f6, f2, f12
            nop
        d.pfmul.ss f8, f7, f2
            adds    2048, r10, r11
        d.pfadd.ss f6, f2, f6
            nop
        d.pfmul.ss f8, f15, f2
            nop
        d.pfadd.ss f6, f2, f6
            nop
        d.pfmul.ss f8, f12, f2
            nop
        d.pfadd.ss f6, f2, f6
            nop
        d.pfadd.ss f2, f5, f2             // coordinate x
            nop
        d.pfadd.ss f2, f5, f2
            st.l    r11, 48(r2)
        d.pfadd.ss f2, f5, f2
            nop
        d.pfadd.ss f0, f0, f2
            nop
        d.pfadd.ss f0, f0, f5
            fst.l   f2, SCRATCH+0(r2)
        d.pfadd.ss f0, f0, f6
            fst.l   f5, SCRATCH+4(r2)
        d.pfmul.ss f0, f0, f22
            nop
        d.pfsub.ss f0, f22, f0
            nop
        d.pfle.ss  f2, f22, f0            // |x| within the guard band
            shr     16, r4, r12
        d.pfmul.ss f0, f0, f22
            nop
        d.pfsub.ss f0, f22, f0
            bc      clipped
        d.pfle.ss  f16, f2, f16
            fst.l   f6, SCRATCH+8(r2)
        d.pfmul.ss f0, f0, f2
            nop
        d.pfsub.ss f0, f2, f0
            bc      clipped
        d.pfle.ss  f5, f22, f17
            fld.l   P_ROWS+16(r20), f16
        d.pfadd.ss f0, f0, f0
            fld.l   P_ROWS+20(r20), f22
        d.pfle.ss  f17, f5, f18
            bc      clipped
        d.pfmul.ss f16, f20, f0           // row y, product 0
            nop
        d.pfmul.ss f16, f21, f0
            bc      clipped
        d.pfmul.ss f16, f23, f0
            and     255, r12, r13
        d.pfmul.ss f22, f24, f5           // row y, product 1
            nop
        d.pfmul.ss f22, f25, f19
            nop
        d.pfmul.ss f22, f4, f16
            nop
        d.pfle.ss  f6, f2, f0
            nop
        d.pfmul.ss f0, f0, f2
            nop
        d.pfadd.ss f5, f2, f0
            bc      clipped
        d.pfle.ss  f18, f6, f0
            fld.l   P_ROWS+24(r20), f2
        d.pfmul.ss f0, f0, f5
            shl     12, r13, r14
        d.pfadd.ss f19, f5, f0
            bc      clipped
        d.pfmul.ss f2, f3, f6             // row y, product 2
            fld.l   P_ROWS+28(r20), f5
        d.pfadd.ss f16, f6, f17
            adds    2048, r14, r15
        d.pfmul.ss f2, f14, f0
            st.l    r15, 56(r2)
        d.pfmul.ss f2, f13, f0
            nop
        d.pfmul.ss f9, f7, f2
            nop
        d.pfadd.ss f17, f2, f0
            nop
        d.pfmul.ss f9, f15, f2
            ld.l    28(r16), r3           // colour of a corner
        d.pfadd.ss f6, f2, f6
            nop
        d.pfmul.ss f9, f12, f2
            nop
        d.pfadd.ss f6, f2, f6
            nop
        d.pfadd.ss f2, f5, f2             // coordinate y
            nop
        d.pfadd.ss f2, f5, f2
            nop
        d.pfadd.ss f2, f5, f2
            nop
        d.pfadd.ss f0, f0, f2
            and     255, r3, r22
        d.pfadd.ss f0, f0, f5
            fst.l   f2, SCRATCH+16(r2)
        d.pfadd.ss f0, f0, f6
            nop
        d.pfmul.ss f0, f0, f22
            nop
        d.pfsub.ss f0, f22, f0
            nop
        d.pfle.ss  f2, f22, f0            // |y| within the guard band
            fst.l   f5, SCRATCH+20(r2)
        d.pfmul.ss f0, f0, f22
            fst.l   f6, SCRATCH+24(r2)
        d.pfsub.ss f0, f22, f0
            bc      clipped
        d.pfle.ss  f17, f2, f17
            fld.l   P_ROWS+32(r20), f16
        d.pfmul.ss f0, f0, f17
            nop
        d.pfsub.ss f0, f17, f0
            bc      clipped
        d.pfmul.ss f16, f20, f0           // row z, product 0
            fld.l   P_ROWS+36(r20), f18
        d.pfmul.ss f16, f21, f0
            shl     12, r22, r23
        d.pfmul.ss f16, f23, f0
            nop
        d.pfmul.ss f18, f24, f16          // row z, product 1
            nop
        d.pfle.ss  f5, f22, f19
            nop
        d.pfmul.ss f18, f25, f24
            nop
        d.pfle.ss  f19, f5, f0
            bc      clipped
        d.pfmul.ss f18, f4, f19
            nop
        d.pfle.ss  f6, f17, f4
            bc      clipped
        d.pfmul.ss f0, f0, f17
            nop
        d.pfadd.ss f16, f17, f0
            bc      clipped
        d.pfmul.ss f0, f0, f18
            adds    2048, r23, r26
        d.pfadd.ss f24, f18, f0
            nop
        d.pfle.ss  f4, f6, f0
            nop
        d.pfmul.ss f0, f0, f18
            fld.l   P_ROWS+40(r20), f4
        d.pfadd.ss f19, f18, f16
            bc      clipped
        d.frcp.ss  f7, f2                 // seeds of 1 / w
            fld.l   P_TWO_S(r20), f17
        d.frcp.ss  f15, f5
            fld.l   P_ROWS+44(r20), f18
        d.frcp.ss  f12, f6
            shr     8, r3, r27
        d.pfmul.ss f7, f2, f0             // a Newton step in single
            st.l    r26, 104(r2)
        d.pfmul.ss f15, f5, f0
            nop
        d.pfmul.ss f12, f6, f0
            nop
        d.pfmul.ss f4, f3, f19            // row z, product 2
            nop
        d.pfmul.ss f4, f14, f3
            and     255, r27, r28
        d.pfmul.ss f4, f13, f14
            nop
        d.pfadd.ss f0, f0, f4
            nop
        d.pfadd.ss f0, f0, f0
            nop
        d.pfadd.ss f0, f0, f13
            nop
        d.pfmul.ss f0, f0, f20
            nop
        d.pfadd.ss f16, f20, f0
            nop
        d.pfmul.ss f0, f0, f16
            nop
        d.pfadd.ss f4, f16, f0
            nop
        d.pfmul.ss f0, f0, f4
            nop
        d.pfadd.ss f13, f4, f0
            nop
        d.pfadd.ss f4, f18, f4            // coordinate z
            shl     12, r28, r29
        d.pfadd.ss f4, f18, f4
            nop
        d.pfadd.ss f4, f18, f4
            nop
        d.pfsub.ss f17, f19, f4
            adds    2048, r29, r30
        d.pfsub.ss f17, f3, f13
            fst.l   f4, SCRATCH+32(r2)
        d.pfle.ss  f0, f4, f3             // between near and far
            fst.l   f13, SCRATCH+36(r2)
        d.pfsub.ss f17, f14, f16
            fst.l   f3, SCRATCH+40(r2)
        d.pfle.ss  f4, f7, f14
            bc      clipped
        d.pfmul.ss f2, f16, f0
            st.l    r30, 112(r2)
        d.pfle.ss  f0, f13, f0
            bc      clipped
        d.pfmul.ss f5, f14, f0
            nop
        d.pfle.ss  f13, f15, f2
            bc      clipped
        d.pfmul.ss f6, f2, f0
            nop
        d.pfle.ss  f0, f3, f0
            bc      clipped
        d.pfmul.ss f0, f0, f2
            nop
        d.pfle.ss  f3, f12, f0
            bc      clipped
        d.pfmul.ss f0, f0, f3
            shr     16, r3, r31
        d.pfle.ss  f10, f7, f0            // w in range
            bc      clipped
        d.pfamov.sdf7, f0                 // to double
            nop
        d.pfamov.sdf2, f0
            bc      clipped
        d.pfamov.sdf15, f0
            and     255, r31, r5
        d.pfamov.sdf3, f4
            shl     12, r5, r6
        d.pfamov.sdf12, f2
            nop
        d.pfle.ss  f7, f11, f16
            nop
        d.pfmul.ss f0, f0, f13
            fld.d   P_TWO(r20), f6
        d.pfamov.sdf13, f18
            bc      clipped
        d.pfmul.dd f4, f2, f0             // a Newton step in double
            nop
        d.pfle.ss  f10, f15, f20
            nop
        d.pfmul.dd f16, f18, f0
            nop
        d.pfle.ss  f15, f11, f0
            bc      clipped
        d.pfadd.ss f0, f0, f14
            nop
        d.pfmul.dd f20, f14, f22
            bc      clipped
        d.pfsub.dd f6, f22, f0
            nop
        d.pfle.ss  f10, f12, f0
            nop
        d.pfmul.dd f0, f0, f22
            nop
        d.pfsub.dd f6, f22, f0
            bc      clipped
        d.pfmul.dd f0, f0, f22
            adds    2048, r6, r7
        d.pfsub.dd f6, f22, f24
            nop
        d.pfmul.dd f2, f24, f0
            nop
        d.pfle.ss  f12, f11, f0
            nop
        d.pfadd.ss f0, f0, f8
            nop
        d.pfmul.dd f18, f8, f0
            bc      clipped
        d.pfadd.ss f0, f0, f10
            fld.l   SCRATCH+0(r2), f8
        d.pfmul.dd f14, f10, f12
            fld.l   SCRATCH+4(r2), f9
        d.fnop
            fld.l   SCRATCH+8(r2), f10
        d.pfmul.dd f4, f12, f22           // a Newton step in double
            fld.l   SCRATCH+16(r2), f11
        d.fnop
            fld.l   SCRATCH+20(r2), f4
        d.pfmul.dd f16, f22, f24
            ld.l    44(r16), r8           // colour of a corner
        d.fnop
            fld.l   SCRATCH+24(r2), f5
        d.pfmul.dd f20, f24, f16
            and     255, r8, r9
        d.pfsub.dd f6, f16, f0
            fld.l   SCRATCH+32(r2), f20
        d.pfmul.dd f0, f0, f16
            st.l    r7, 120(r2)
        d.pfsub.dd f6, f16, f0
            fld.l   SCRATCH+36(r2), f21
        d.pfmul.dd f0, f0, f26
            fld.l   SCRATCH+40(r2), f16
        d.pfsub.dd f6, f26, f0
            fld.q   P_SCREEN(r20), f28
        d.pfadd.ss f0, f0, f6
            fld.l   P_ROUND_S(r20), f17
        d.pfmul.dd f12, f6, f0
            nop
        d.pfadd.ss f0, f0, f6
            shl     12, r9, r10
        d.pfmul.dd f22, f6, f0
            nop
        d.pfadd.ss f0, f0, f6
            nop
        d.pfmul.dd f24, f6, f12
            nop
        d.pfamov.dsf12, f0                // 1 / w
            nop
        d.pfmul.dd f0, f0, f6
            nop
        d.pfamov.dsf6, f0
            nop
        d.pfmul.dd f0, f0, f6
            nop
        d.pfamov.dsf6, f0
            nop
        d.pfadd.ss f0, f0, f6
            adds    2048, r10, r11
        d.pfmul.ss f20, f6, f0            // z / w
            st.l    r11, 168(r2)
        d.pfmul.ss f8, f6, f0             // x / w
            nop
        d.pfmul.ss f11, f6, f0            // y / w
            nop
        d.pfadd.ss f0, f0, f8
            nop
        d.pfmul.ss f21, f8, f11
            nop
        d.pfmul.ss f9, f8, f6
            nop
        d.pfmul.ss f4, f8, f7
            nop
        d.pfmul.ss f6, f28, f4            // to the screen, x
            nop
        d.pfmul.ss f7, f29, f6            // to the screen, y
            nop
        d.pfmul.ss f28, f6, f7
            nop
        d.pfadd.ss f0, f0, f6
            nop
        d.pfmul.ss f16, f6, f8
            nop
        d.pfmul.ss f10, f6, f9
            nop
        d.pfmul.ss f5, f6, f10
            shr     8, r8, r4
        d.pfmul.ss f7, f29, f5
            and     255, r4, r12
        d.pfadd.ss f8, f30, f0
            nop
        d.pfadd.ss f10, f30, f0
            nop
        d.pfadd.ss f9, f31, f0
            nop
        d.pfadd.ss f10, f17, f10          // snapped: integer in the low bits
            nop
        d.pfadd.ss f10, f17, f10
            nop
        d.pfadd.ss f10, f17, f10          // snapped: integer in the low bits
            nop
        d.pfmul.ss f0, f0, f10
            nop
        d.pfmul.ss f28, f10, f16
            nop
        d.pfmul.ss f29, f16, f10
            nop
        d.pfadd.ss f10, f31, f6
            nop
        d.pfsub.ss f6, f17, f8
            nop
        d.pfsub.ss f8, f17, f7
            nop
        d.pfadd.ss f10, f17, f10
            nop
        d.pfamov.sdf10, f10
            nop
        d.pfmul.ss f0, f0, f0
            nop
        d.pfmul.ss f0, f0, f10
            nop
        d.pfadd.ss f10, f30, f16
            nop
        d.pfamov.sdf16, f9
            shl     12, r12, r13
        d.pfmul.ss f0, f0, f10
            nop
        d.pfadd.ss f10, f31, f12
            nop
        d.pfadd.ss f10, f17, f10
            fst.d   f12, 0(r2)
        d.pfsub.ss f7, f17, f20
            adds    2048, r13, r14
        d.pfadd.ss f10, f17, f10
            fst.d   f20, 64(r2)
        d.pfsub.ss f22, f17, f22
            fst.d   f6, 16(r2)
        d.pfsub.ss f9, f17, f10
            st.l    r14, 176(r2)
        d.pfsub.ss f23, f17, f23
            fst.d   f8, 80(r2)
        d.pfamov.sdf16, f16
            fst.d   f22, 144(r2)
        d.pfamov.sdf10, f17
            fld.l   P_FLIP(r20), f16
        d.pfamov.sdf17, f10
            nop
        d.pfamov.sdf10, f24
            nop
        d.fzchkl   f6, f8, f26            // bounding box
            fst.d   f24, 128(r2)
        d.fisub.ss f16, f6, f28
            shr     16, r8, r15
        d.fisub.ss f16, f7, f29
            nop
        d.fisub.ss f16, f8, f6
            nop
        d.fisub.ss f16, f9, f7
            nop
        d.fisub.ss f16, f22, f8
            nop
        d.fzchkl   f26, f22, f30
            nop
        d.pfadd.ss f0, f0, f2
            nop
        d.pfadd.ss f0, f0, f18
            fst.d   f2, 8(r2)
        d.fisub.ss f16, f23, f9
            fst.d   f18, 72(r2)
        d.fzchkl   f28, f6, f16
            and     255, r15, r22
        d.pfadd.ss f0, f0, f14
            fst.d   f30, LOW(r2)
        d.fzchkl   f16, f8, f6
            fst.d   f14, 136(r2)
        d.pfamov.sdf11, f0                // depth
            fld.d   P_DEPTH(r20), f8
        d.pfamov.sdf4, f0
            fld.d   P_NEAR(r20), f10
        d.pfamov.sdf5, f0
            fld.d   P_HALF(r20), f16
        d.pfsub.dd f20, f12, f22          // twice the area
            fld.d   P_TWO52(r20), f4
        d.pfmul.dd f8, f22, f0
            shl     12, r22, r23
        d.pfsub.dd f14, f2, f20
            adds    2048, r23, r26
        d.pfsub.dd f18, f2, f14
            fst.d   f6, HIGH(r2)
        d.pfmul.dd f20, f8, f0
            st.l    r26, 184(r2)
        d.pfsub.dd f24, f12, f2
            nop
        d.pfmul.dd f14, f8, f6
            nop
        d.pfadd.dd f6, f10, f8
            nop
        d.pfmul.dd f2, f8, f6
            nop
        d.pfadd.dd f6, f10, f2
            nop
        d.pfmul.dd f0, f0, f6
            nop
        d.pfadd.dd f6, f10, f8
            nop
        d.pfadd.dd f6, f16, f6
            nop
        d.pfmul.dd f2, f8, f6
            nop
        d.pfadd.dd f2, f16, f2
            nop
        d.pfadd.ss f0, f0, f2
            nop
        d.pfadd.ss f0, f0, f8
            nop
        d.pfadd.ss f0, f0, f10
            nop
        d.pfmul.dd f0, f0, f0
            nop
        d.fnop
            nop
        d.pfmul.dd f0, f0, f12
            nop
        d.pfsub.dd f6, f12, f0
            nop
        d.pfadd.dd f2, f16, f0
            nop
        d.pfadd.ss f0, f0, f0
            nop
        d.pfadd.ss f0, f0, f2
            nop
        d.pfadd.ss f0, f0, f6
            fst.d   f2, AREA(r2)
        d.pfadd.dd f8, f4, f0             // nearest integer
            nop
        d.pfadd.dd f10, f4, f0
            nop
        d.pfadd.dd f6, f4, f0
            nop
        d.pfsub.dd f2, f4, f2
            nop
        d.pfsub.dd f12, f4, f12
            fst.l   f2, DEPTH+0(r2)
        d.pfsub.dd f2, f4, f2
            fst.l   f12, DEPTH+16(r2)
        d.pfsub.dd f8, f4, f4             // negative where it was rounded up
            fst.l   f2, DEPTH+32(r2)
        d.pfsub.dd f10, f2, f2
            ld.l    DEPTH+0(r2), r27
        d.pfsub.dd f6, f2, f2
            ld.l    DEPTH+16(r2), r28
        d.pfadd.ss f0, f0, f2
            ld.l    DEPTH+32(r2), r29
        d.pfadd.ss f0, f0, f4
            fst.l   f3, DEPTH+8(r2)
        d.pfadd.ss f0, f0, f2
            fst.l   f5, DEPTH+24(r2)
        d.fnop
            fst.l   f3, DEPTH+40(r2)
        d.fnop
            ld.l    DEPTH+8(r2), r30
        d.fnop
            ld.l    DEPTH+24(r2), r3
        d.fnop
            ld.l    DEPTH+40(r2), r31
        d.fnop
            shra    31, r30, r5
        d.fnop
            shra    31, r3, r6
        d.fnop
            shra    31, r31, r7
        d.fnop
            adds    r5, r27, r9
        d.fnop
            adds    r6, r28, r10
        d.fnop
            adds    r7, r29, r11
        d.fnop
            st.l    r9, 32(r2)
        fnop
            st.l    r10, 96(r2)
        fnop
            st.l    r11, 160(r2)
        adds    64, r2, r24                 // corners 1 and 2
        adds    128, r2, r25
        fld.d   AREA(r2), f8
        pfgt.dd f8, f0, f0
        bc      oriented
        pfeq.dd f8, f0, f0
        bc      done                        // nothing to draw
        adds    128, r2, r24                // make it clockwise
        adds    64, r2, r25
        fsub.dd f0, f8, f8
        fst.d   f8, AREA(r2)
        .align  8

// ---- edges, pixel of reference, planes, command words
oriented: d.fnop
            nop
        d.fnop
            fld.d   AREA(r2), f2          // area, positive now
        d.fnop
            fld.d   P_TWO(r20), f4
        d.fnop
            ld.l    20(r2), r4
        d.frcp.dd  f2, f6                 // seed of 1 / area
            ld.l    20(r24), r5
        d.fnop
            ld.l    20(r25), r6
        d.pfmul.dd f2, f6, f0             // Newton step 1 for 1 / area
            ld.l    16(r2), r7
        d.fnop
            ld.l    16(r24), r8
        d.pfmul.dd f0, f0, f0
            ld.l    16(r25), r9
        d.fnop
            subs    r4, r5, r10           // edge 0
        d.pfmul.dd f0, f0, f8
            subs    r8, r7, r11
        d.pfsub.dd f4, f8, f0
            subs    r0, r10, r12
        d.pfadd.ss f0, f0, f0
            or      r12, r10, r13
        d.pfadd.ss f0, f0, f0
            subs    r0, r11, r14
        d.pfadd.ss f0, f0, f8
            shra    31, r13, r15
        d.pfmul.dd f6, f8, f0
            shra    31, r14, r3
        d.fnop
            fld.d   0(r2), f6
        d.pfmul.dd f0, f0, f0
            fld.d   0(r24), f8
        d.fnop
            fld.d   8(r2), f10
        d.pfmul.dd f0, f0, f12
            fld.d   8(r24), f14
        d.pfsub.dd f8, f6, f0
            fld.d   P_EIGHT(r20), f16
        d.pfadd.ss f0, f0, f0
            shra    31, r12, r22
        d.pfadd.ss f0, f0, f0
            andnot  r15, r3, r23
        d.pfadd.ss f0, f0, f8
            or      r23, r22, r26
        d.fnop
            shl     3, r26, r27
        d.fnop
            adds    r27, r20, r28
        d.fnop
            st.l    r10, 8(r18)
        d.pfsub.dd f14, f10, f0
            st.l    r11, 12(r18)
        d.pfmul.dd f2, f12, f0            // Newton step 2 for 1 / area
            subs    r5, r6, r29           // edge 1
        d.pfsub.dd f16, f10, f0
            subs    r9, r8, r30
        d.pfsub.dd f16, f6, f0
            subs    r0, r29, r31
        d.pfmul.dd f0, f0, f0
            shra    31, r31, r13
        d.pfadd.ss f0, f0, f6
            fld.d   P_TIE_OUT(r28), f10
        d.pfmul.dd f0, f0, f16
            fld.d   P_SIXTEENTH(r20), f14
        d.pfsub.dd f4, f16, f20
            fld.d   P_ROUND(r20), f18
        d.pfmul.dd f8, f20, f0
            st.l    r29, 24(r18)
        d.pfadd.ss f0, f0, f16
            or      r31, r29, r14
        d.pfmul.dd f6, f16, f0
            st.l    r30, 28(r18)
        d.pfadd.ss f0, f0, f0
            shra    31, r14, r12
        d.pfadd.ss f0, f0, f16
            nop
        d.pfmul.dd f12, f16, f20
            nop
        d.fnop
            nop
        d.pfmul.dd f0, f0, f12
            nop
        d.pfsub.dd f20, f12, f0
            nop
        d.pfmul.dd f0, f0, f12
            subs    r0, r30, r15
        d.pfadd.ss f0, f0, f0
            shra    31, r15, r3
        d.pfadd.ss f0, f0, f0
            nop
        d.pfadd.dd f16, f10, f16          // top and left edges own their pixels
            nop
        d.pfadd.ss f0, f0, f0
            andnot  r12, r3, r22
        d.pfadd.ss f0, f0, f0
            or      r22, r13, r23
        d.pfadd.ss f0, f0, f10
            shl     3, r23, r26
        d.pfmul.dd f14, f10, f0
            nop
        d.fnop
            adds    r26, r20, r10
        d.pfmul.dd f0, f0, f0
            nop
        d.fnop
            nop
        d.pfmul.dd f0, f0, f10
            nop
        d.pfadd.dd f10, f18, f0
            nop
        d.pfadd.ss f0, f0, f0
            fld.d   P_EIGHT(r20), f10
        d.pfadd.ss f0, f0, f0
            nop
        d.pfadd.ss f0, f0, f14
            nop
        d.fnop
            fst.l   f14, 16(r18)
        d.pfmul.dd f2, f12, f0            // Newton step 3 for 1 / area
            fld.d   0(r24), f14
        d.fnop
            fld.d   0(r25), f2
        d.pfmul.dd f0, f0, f0
            fld.d   8(r24), f16
        d.pfsub.dd f10, f14, f0
            fld.d   8(r25), f18
        d.pfsub.dd f2, f14, f0
            subs    r6, r4, r11           // edge 2
        d.pfsub.dd f10, f16, f0
            subs    r7, r9, r27
        d.pfsub.dd f18, f16, f10
            fld.d   P_TIE_OUT(r10), f2
        d.pfmul.dd f0, f0, f14
            subs    r0, r11, r5
        d.pfsub.dd f4, f14, f16
            shra    31, r5, r8
        d.pfadd.ss f0, f0, f14
            fld.d   P_SIXTEENTH(r20), f4
        d.pfmul.dd f16, f14, f0
            fld.d   P_ROUND(r20), f18
        d.pfadd.ss f0, f0, f14
            or      r5, r11, r28
        d.pfmul.dd f10, f14, f0
            st.l    r11, 40(r18)
        d.pfadd.ss f0, f0, f10
            shra    31, r28, r29
        d.pfmul.dd f12, f10, f14
            st.l    r27, 44(r18)
        d.fnop
            nop
        d.pfmul.dd f0, f0, f10
            nop
        d.pfsub.dd f14, f10, f0
            nop
        d.pfmul.dd f0, f0, f10
            subs    r0, r27, r31
        d.pfadd.ss f0, f0, f0
            shra    31, r31, r14
        d.pfadd.ss f0, f0, f0
            nop
        d.pfadd.dd f12, f2, f12           // top and left edges own their pixels
            nop
        d.pfadd.ss f0, f0, f0
            andnot  r29, r14, r30
        d.pfadd.ss f0, f0, f0
            or      r30, r8, r15
        d.pfadd.ss f0, f0, f2
            shl     3, r15, r12
        d.pfmul.dd f4, f2, f0
            nop
        d.fnop
            adds    r12, r20, r3
        d.pfmul.dd f0, f0, f0
            nop
        d.fnop
            nop
        d.pfmul.dd f0, f0, f2
            nop
        d.pfadd.dd f2, f18, f0
            nop
        d.pfadd.ss f0, f0, f0
            fld.d   P_EIGHT(r20), f2
        d.pfadd.ss f0, f0, f0
            nop
        d.pfadd.ss f0, f0, f4
            nop
        d.fnop
            fst.l   f4, 32(r18)
        d.fnop
            ld.l    LOW(r2), r13          // bounding box to integers
        d.fnop
            fld.d   0(r25), f4
        d.fnop
            ld.l    LOW+4(r2), r22
        d.fnop
            fld.d   0(r2), f12
        d.pfsub.dd f2, f4, f0
            ld.l    HIGH(r2), r23
        d.pfadd.ss f0, f0, f0
            fld.d   8(r25), f14
        d.pfsub.dd f4, f12, f0
            ld.l    HIGH+4(r2), r26
        d.pfadd.ss f0, f0, f4
            fld.d   8(r2), f12
        d.pfsub.dd f2, f14, f0
            orh     0x4B40, r0, r4
        d.pfadd.ss f0, f0, f2
            orh     0x4BC0, r0, r6
        d.pfsub.dd f14, f12, f0
            fld.d   P_TIE_OUT(r3), f16
        d.pfadd.ss f0, f0, f12
            subs    r13, r4, r7
        d.pfmul.dd f2, f12, f0
            subs    r22, r4, r9
        d.pfadd.ss f0, f0, f0
            fld.d   P_SIXTEENTH(r20), f12
        d.pfadd.ss f0, f0, f14
            fld.d   P_ROUND(r20), f18
        d.pfmul.dd f4, f14, f0
            st.l    r7, BOX+0(r2)
        d.fnop
            subs    r6, r23, r10
        d.pfmul.dd f0, f0, f4
            st.l    r9, BOX+8(r2)
        d.fnop
            nop
        d.pfmul.dd f0, f0, f20
            nop
        d.pfsub.dd f20, f4, f0
            nop
        d.pfadd.ss f0, f0, f0
            subs    r6, r26, r11
        d.pfadd.ss f0, f0, f0
            st.l    r10, BOX+4(r2)
        d.pfadd.dd f4, f16, f4            // top and left edges own their pixels
            nop
        d.pfadd.ss f0, f0, f0
            shra    31, r7, r5            // within the picture
        d.pfadd.ss f0, f0, f0
            or      10239, r0, r28
        d.pfadd.ss f0, f0, f4
            st.l    r11, BOX+12(r2)
        d.pfmul.dd f12, f4, f0
            nop
        d.fnop
            andnot  r5, r7, r27
        d.pfmul.dd f0, f0, f0
            nop
        d.fnop
            nop
        d.pfmul.dd f0, f0, f4
            nop
        d.pfadd.dd f4, f18, f0
            nop
        d.pfadd.ss f0, f0, f0
            subs    r28, r27, r31
        d.pfadd.ss f0, f0, f0
            nop
        d.pfadd.ss f0, f0, f4
            nop
        d.fnop
            fst.l   f4, 48(r18)
        d.fnop
            shra    31, r10, r29          // within the picture
        d.fnop
            andnot  r29, r10, r14
        d.fnop
            subs    r28, r14, r8
        d.fnop
            shra    31, r31, r30
        d.fnop
            shra    31, r8, r15
        d.fnop
            and     r30, r31, r12
        d.fnop
            and     r15, r8, r3
        d.fnop
            shra    31, r9, r13           // within the picture
        d.fnop
            shra    31, r11, r22          // within the picture
        d.fnop
            adds    r12, r27, r4
        d.fnop
            adds    r3, r14, r23
        d.fnop
            or      7679, r0, r26
        d.fnop
            andnot  r13, r9, r6
        d.fnop
            andnot  r22, r11, r7
        d.fnop
            adds    r4, r23, r5
        d.fnop
            subs    r26, r6, r10
        d.fnop
            subs    r26, r7, r29
        d.fnop
            shra    5, r5, r28
        d.fnop
            shra    31, r10, r31
        d.fnop
            shra    31, r29, r30
        d.fnop
            st.l    r28, REFX(r2)
        d.fnop
            and     r31, r10, r8
        d.fnop
            and     r30, r29, r15
        d.fnop
            adds    r8, r6, r27
        d.fnop
            adds    r15, r7, r12
        d.fnop
            fld.d   P_TWO52(r20), f4
        d.fnop
            fld.d   REFX(r2), f12
        d.fnop
            adds    r27, r12, r14
        d.fnop
            shra    5, r14, r3
        d.pfsub.dd f12, f4, f0            // pixel of reference, x
            st.l    r3, REFY(r2)
        d.pfadd.ss f0, f0, f0
            fld.d   P_HALF(r20), f16
        d.pfadd.ss f0, f0, f0
            fld.d   0(r2), f18
        d.pfadd.ss f0, f0, f20
            fld.d   P_SIXTEENTH(r20), f22
        d.pfadd.dd f20, f16, f0
            fld.d   REFY(r2), f24
        d.pfadd.ss f0, f0, f0
            fld.d   P_SIXTEEN(r20), f26
        d.pfmul.dd f18, f22, f0
            fld.d   8(r2), f28
        d.pfsub.dd f24, f4, f0            // pixel of reference, y
            fld.d   P_SIXTEENTH(r20), f18
        d.pfmul.dd f10, f26, f0           // 16 / area
            fld.d   P_ROUND(r20), f4
        d.pfadd.ss f0, f0, f10
            fst.d   f20, KEEP+0(r2)
        d.pfmul.dd f28, f18, f22
            fld.d   32(r2), f20
        d.pfsub.dd f10, f22, f0
            fld.d   32(r24), f18
        d.pfadd.dd f22, f16, f22
            fld.d   32(r25), f10
        d.pfmul.dd f0, f0, f16
            fst.d   f22, KEEP+8(r2)
        d.pfsub.dd f18, f20, f0           // plane of depth
            nop
        d.pfsub.dd f10, f20, f18
            nop
        d.pfadd.ss f0, f0, f10
            fst.d   f18, KEEP+16(r2)
        d.pfadd.ss f0, f0, f18
            fld.d   P_TWO52(r20), f22
        d.pfmul.dd f14, f18, f26
            nop
        d.pfsub.dd f10, f26, f28
            nop
        d.pfmul.dd f6, f28, f0
            nop
        d.pfsub.dd f20, f22, f0
            nop
        d.pfmul.dd f28, f8, f10
            nop
        d.pfadd.ss f0, f0, f0
            nop
        d.pfmul.dd f18, f2, f20
            nop
        d.pfsub.dd f10, f20, f18
            nop
        d.pfmul.dd f0, f0, f10
            fst.d   f18, KEEP+24(r2)
        d.pfadd.ss f0, f0, f18
            fld.d   KEEP+16(r2), f20
        d.pfmul.dd f0, f0, f26
            fld.d   KEEP+24(r2), f22
        d.pfsub.dd f10, f26, f0
            fld.d   KEEP(r2), f28
        d.pfadd.ss f0, f0, f26
            fld.d   KEEP+8(r2), f10
        d.pfmul.dd f16, f26, f0           // slopes
            nop
        d.pfadd.ss f0, f0, f0
            nop
        d.pfadd.ss f0, f0, f26
            nop
        d.pfmul.dd f16, f26, f0
            nop
        d.fnop
            nop
        d.pfmul.dd f0, f0, f26
            nop
        d.pfadd.dd f26, f4, f0
            nop
        d.pfmul.dd f26, f20, f30
            nop
        d.pfadd.dd f30, f4, f0
            nop
        d.pfmul.dd f30, f22, f0
            nop
        d.pfadd.ss f0, f0, f0
            nop
        d.pfsub.dd f20, f4, f20
            nop
        d.pfsub.dd f22, f4, f22
            fst.l   f20, 56(r18)
        d.pfadd.ss f0, f0, f0
            fld.d   P_HEADS(r20), f20     // instruction head
        d.pfadd.ss f0, f0, f26
            fst.l   f22, 60(r18)
        d.pfmul.dd f28, f26, f30
            fld.d   40(r2), f22
        d.pfadd.dd f18, f30, f28
            fld.d   40(r24), f26
        d.pfmul.dd f10, f28, f18
            fld.d   40(r25), f30
        d.pfadd.ss f0, f0, f0
            ld.l    P_HEADS+8(r20), r9    // instruction head
        d.pfsub.dd f26, f22, f0           // plane of red
            fst.d   f20, 0(r18)
        d.pfsub.dd f30, f22, f10
            st.l    r9, 52(r18)
        d.pfadd.dd f10, f18, f0
            nop
        d.pfadd.ss f0, f0, f10
            nop
        d.pfmul.dd f14, f10, f18
            nop
        d.pfadd.ss f0, f0, f20
            nop
        d.pfmul.dd f6, f20, f26
            nop
        d.pfadd.dd f18, f26, f28
            nop
        d.pfmul.dd f20, f8, f18
            nop
        d.pfadd.dd f28, f4, f0
            nop
        d.pfmul.dd f10, f2, f26
            fld.d   P_TWO52(r20), f20
        d.pfsub.dd f18, f26, f0
            nop
        d.pfadd.dd f10, f4, f10
            nop
        d.pfsub.dd f22, f20, f10
            nop
        d.pfmul.dd f0, f0, f18
            nop
        d.pfadd.ss f0, f0, f20
            nop
        d.pfmul.dd f0, f0, f22
            nop
        d.pfsub.dd f18, f22, f26
            nop
        d.fisub.ss f10, f26, f18          // back to pixel 0, 0
            nop
        d.pfmul.dd f20, f16, f0           // slopes
            nop
        d.pfadd.ss f0, f0, f10
            fst.l   f18, 64(r18)
        d.pfadd.ss f0, f0, f0
            fld.d   KEEP+16(r2), f18
        d.pfadd.ss f0, f0, f22
            fld.d   KEEP+24(r2), f20
        d.pfmul.dd f16, f22, f0
            fld.d   KEEP(r2), f12
        d.fnop
            fld.d   KEEP+8(r2), f24
        d.pfmul.dd f0, f0, f22
            nop
        d.pfadd.dd f22, f4, f0
            nop
        d.pfmul.dd f22, f18, f26
            nop
        d.pfadd.dd f26, f4, f0
            nop
        d.pfmul.dd f26, f20, f0
            nop
        d.pfadd.ss f0, f0, f0
            nop
        d.pfsub.dd f18, f4, f18
            nop
        d.pfsub.dd f20, f4, f20
            fst.l   f18, 76(r18)
        d.pfadd.ss f0, f0, f0
            ld.l    P_HEADS+12(r20), r13  // instruction head
        d.pfadd.ss f0, f0, f18
            fst.l   f20, 80(r18)
        d.pfmul.dd f12, f18, f22
            fld.d   48(r2), f20
        d.pfadd.dd f10, f22, f18
            fld.d   48(r24), f12
        d.pfmul.dd f24, f18, f10
            fld.d   48(r25), f22
        d.pfadd.ss f0, f0, f0
            ld.l    P_HEADS+16(r20), r11  // instruction head
        d.pfsub.dd f12, f20, f0           // plane of green
            st.l    r13, 68(r18)
        d.pfsub.dd f22, f20, f12
            st.l    r11, 72(r18)
        d.pfadd.dd f12, f10, f0
            nop
        d.pfadd.ss f0, f0, f10
            nop
        d.pfmul.dd f14, f10, f12
            nop
        d.pfadd.ss f0, f0, f18
            nop
        d.pfmul.dd f6, f18, f22
            nop
        d.pfadd.dd f12, f22, f24
            nop
        d.pfmul.dd f18, f8, f12
            nop
        d.pfadd.dd f24, f4, f0
            nop
        d.pfmul.dd f10, f2, f22
            fld.d   P_TWO52(r20), f18
        d.pfsub.dd f12, f22, f0
            nop
        d.pfadd.dd f10, f4, f10
            nop
        d.pfsub.dd f20, f18, f10
            nop
        d.pfmul.dd f0, f0, f12
            nop
        d.pfadd.ss f0, f0, f18
            nop
        d.pfmul.dd f0, f0, f20
            nop
        d.pfsub.dd f12, f20, f22
            nop
        d.fisub.ss f10, f22, f12          // back to pixel 0, 0
            nop
        d.pfmul.dd f18, f16, f0           // slopes
            nop
        d.pfadd.ss f0, f0, f10
            fst.l   f12, 84(r18)
        d.pfadd.ss f0, f0, f0
            fld.d   KEEP+16(r2), f12
        d.pfadd.ss f0, f0, f20
            fld.d   KEEP+24(r2), f18
        d.pfmul.dd f16, f20, f0
            fld.d   KEEP(r2), f22
        d.fnop
            fld.d   KEEP+8(r2), f20
        d.pfmul.dd f0, f0, f24
            nop
        d.pfadd.dd f24, f4, f0
            nop
        d.pfmul.dd f24, f12, f26
            nop
        d.pfadd.dd f26, f4, f0
            nop
        d.pfmul.dd f26, f18, f0
            nop
        d.pfadd.ss f0, f0, f0
            nop
        d.pfsub.dd f12, f4, f12
            nop
        d.pfsub.dd f18, f4, f18
            fst.l   f12, 92(r18)
        d.pfadd.ss f0, f0, f0
            ld.l    P_HEADS+20(r20), r22  // instruction head
        d.pfadd.ss f0, f0, f12
            fst.l   f18, 96(r18)
        d.pfmul.dd f22, f12, f24
            fld.d   56(r2), f18
        d.pfadd.dd f10, f24, f22
            fld.d   56(r24), f12
        d.pfmul.dd f20, f22, f10
            fld.d   56(r25), f24
        d.pfadd.ss f0, f0, f0
            ld.l    P_HEADS+24(r20), r4   // instruction head
        d.pfsub.dd f12, f18, f0           // plane of blue
            st.l    r22, 88(r18)
        d.pfsub.dd f24, f18, f12
            st.l    r4, 104(r18)
        d.pfadd.dd f12, f10, f0
            nop
        d.pfadd.ss f0, f0, f10
            nop
        d.pfmul.dd f14, f10, f12
            nop
        d.pfadd.ss f0, f0, f14
            nop
        d.pfmul.dd f6, f14, f20
            nop
        d.pfadd.dd f12, f20, f6
            nop
        d.pfmul.dd f14, f8, f12
            nop
        d.pfadd.dd f6, f4, f0
            nop
        d.pfmul.dd f10, f2, f8
            fld.d   P_TWO52(r20), f6
        d.pfsub.dd f12, f8, f0
            nop
        d.pfadd.dd f2, f4, f2
            nop
        d.pfsub.dd f18, f6, f2
            nop
        d.pfmul.dd f0, f0, f6
            nop
        d.pfadd.ss f0, f0, f8
            nop
        d.pfmul.dd f0, f0, f10
            nop
        d.pfsub.dd f6, f10, f12
            nop
        d.fisub.ss f2, f12, f6            // back to pixel 0, 0
            nop
        d.pfmul.dd f8, f16, f0            // slopes
            nop
        d.pfadd.ss f0, f0, f2
            fst.l   f6, 100(r18)
        d.pfadd.ss f0, f0, f0
            fld.d   KEEP+16(r2), f6
        d.pfadd.ss f0, f0, f10
            fld.d   KEEP+24(r2), f8
        d.pfmul.dd f16, f10, f0
            fld.d   KEEP(r2), f12
        d.fnop
            fld.d   KEEP+8(r2), f10
        d.pfmul.dd f0, f0, f14
            nop
        d.pfadd.dd f14, f4, f0
            nop
        d.pfmul.dd f14, f6, f16
            nop
        d.pfadd.dd f16, f4, f0
            nop
        d.pfmul.dd f16, f8, f0
            nop
        d.pfadd.ss f0, f0, f0
            nop
        d.pfsub.dd f6, f4, f6
            nop
        d.pfsub.dd f8, f4, f8
            fst.l   f6, 108(r18)
        d.pfadd.ss f0, f0, f0
            ld.l    P_HEADS+4(r20), r23   // instruction head
        d.pfadd.ss f0, f0, f6
            fst.l   f8, 112(r18)
        d.pfmul.dd f12, f6, f8
            ld.l    P_HEADS+4(r20), r26   // instruction head
        d.pfadd.dd f2, f8, f6
            st.l    r23, 20(r18)
        d.pfmul.dd f10, f6, f2
            st.l    r26, 36(r18)
        d.pfadd.ss f0, f0, f0
            nop
        d.pfadd.ss f0, f0, f0
            nop
        d.pfadd.dd f6, f2, f6
            nop
        d.pfmul.dd f0, f0, f2
            nop
        d.pfadd.ss f0, f0, f0
            nop
        d.pfmul.dd f0, f0, f6
            nop
        d.pfadd.dd f2, f6, f0
            nop
        d.pfadd.dd f2, f4, f2
            nop
        d.pfadd.ss f0, f0, f0
            nop
        d.pfadd.dd f2, f4, f2
            nop
        d.pfadd.ss f0, f0, f2
            nop
        d.pfadd.ss f0, f0, f0
            nop
        d.pfadd.ss f0, f0, f4
            nop
        d.fisub.ss f2, f4, f6             // back to pixel 0, 0
            nop
        fnop
            nop
        fnop
            fst.l   f6, 116(r18)
        call    bins
        nop
        bte     r0, r22, done               // no region: the next command overwrites this one
        adds    COMMAND_BYTES, r18, r18
done:   adds    -1, r17, r17
        adds    TRIANGLE_BYTES, r16, r16
        btne    r0, r17, next
        ld.l    SAVE(r2), r1
        nop
        bri     r1
        nop

// ---- not wholly inside the guard band: leave dual-instruction mode, then to the list
        .align  8
clipped: fnop
            nop
        fnop
            nop
        st.l    r16, 0(r21)
        br      done
        adds    4, r21, r21
