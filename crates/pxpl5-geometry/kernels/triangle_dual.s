// One Gouraud triangle after another in dual-instruction mode: a floating-point and a core operation in every clock.
//
// Triangles go through in batches of up to 16: a first pass over the batch does the corners and leaves a record of each
// triangle, a second one adds its surface (light or normals), a third one turns the records into commands and bins. The
// code of each pass fits the 4 KB instruction cache, the records and the rest fit the data cache.
//
// Every pair is two lines: the floating-point half, then the core half indented further. The comment says where a
// step begins; the pairs of several steps overlap. Three corners go through the pipes side by side, then three edges,
// then the planes of depth and colours. Results leave a pipe into the destination of a later operation of the same
// unit, so the register at the end of a line belongs to an earlier step. Arithmetic and its order are those of the
// native transform and set-up; only 1 / w and 16 / area are formed by Newton steps (in double precision) instead of
// divisions.


// ---- record of a triangle. A corner: x, y (double), x and y as biased integers, (8 free), then depth and three words of
// its surface under the high word of 2^52, so that each reads as a double.
SOURCE  = 24        // the triangle in the display list
AREA    = 192       // twice the area, double
LOW     = 200       // least x, y of the corners, biased by 0x4B400000
HIGH    = 208       // 0x97000000 less the greatest x, y, biased
RECORD_BYTES = 224
BATCH_TRIANGLES = 16

// ---- stack frame
SAVE    = 0         // return address
BOX     = 8         // low x, high x, low y, high y
REFX    = 24        // pixel of reference under the high word of 2^52
REFY    = 32
KEEP    = 40        // pixel of reference x, y; corner 0 to it x, y (double)
STEP_X0 = 72        // corner 0 to 1 and 0 to 2, double
STEP_Y0 = 80
STEP_X2 = 88
STEP_Y2 = 96
PERPIX  = 104       // 16 / twice the area, double
SCRATCH = 112       // clip coordinates x, y, z: 16 bytes each
DEPTH   = 160       // three times 16 bytes
BATCH   = 224       // records

        .macro  edgeword k, n, to
        ld.l    8+16*\k+4*\n(r18), \to
        .endm

        .macro  high n
        st.l    r5, 64*\n+36(r3)
        st.l    r5, 64*\n+44(r3)
        st.l    r5, 64*\n+52(r3)
        st.l    r5, 64*\n+60(r3)
        .endm

        .align  32
start:  st.l    r1, SAVE(r2)
        orh     0x4330, r0, r5              // high word of 2^52
        st.l    r5, REFX+4(r2)
        st.l    r5, REFY+4(r2)
        adds    BATCH, r2, r3
        mov     BATCH_TRIANGLES, r4
prepare: high   0
        high    1
        high    2
        adds    RECORD_BYTES, r3, r3
        adds    -1, r4, r4
        btne    r0, r4, prepare

// ---- first pass: r3 record, r4 triangles left in the batch
batch:  adds    BATCH, r2, r3
        mov     BATCH_TRIANGLES, r4
        subs    r17, r4, r0
        bnc     next                        // more than a batch left
        mov     r17, r4
        .align  32

// ---- corners: transform, guard band, 1 / w, screen, depth, bounding box, area
next:   d.fnop
            nop
        d.fnop
            fld.q   0(r16), f4            // corners
        d.fnop
            fld.q   32(r16), f8
        d.fnop
            fld.q   64(r16), f12
        d.fnop
            fld.q   P_ORIGIN(r20), f16    // eye
        d.fnop
            fld.l   P_ROWS+48(r20), f2
        d.pfsub.ss  f4, f16, f0           // relative to the eye, x
            fld.l   P_ROWS+52(r20), f3
        d.pfsub.ss  f8, f16, f0
            nop
        d.pfsub.ss  f12, f16, f0
            nop
        d.pfsub.ss  f5, f17, f20          // relative to the eye, y
            nop
        d.pfsub.ss  f9, f17, f21
            nop
        d.pfsub.ss  f13, f17, f22
            nop
        d.pfsub.ss  f6, f18, f23          // relative to the eye, z
            fld.l   P_ROWS+56(r20), f24
        d.pfsub.ss  f10, f18, f25
            nop
        d.pfsub.ss  f14, f18, f4
            nop
        d.pfmul.ss  f2, f20, f0           // row w, product 0
            nop
        d.pfmul.ss  f2, f21, f0
            nop
        d.pfmul.ss  f2, f22, f0
            nop
        d.pfmul.ss  f3, f23, f5           // row w, product 1
            fld.l   P_ROWS+60(r20), f2
        d.pfmul.ss  f3, f25, f6
            nop
        d.pfmul.ss  f3, f4, f7
            nop
        d.pfadd.ss  f0, f0, f3
            fld.q   P_GUARD(r20), f8
        d.pfmul.ss  f24, f3, f12          // row w, product 2
            nop
        d.pfadd.ss  f5, f12, f13
            nop
        d.pfmul.ss  f24, f13, f12
            fld.l   P_ROWS+0(r20), f5
        d.pfadd.ss  f6, f12, f14
            nop
        d.pfmul.ss  f24, f14, f6
            nop
        d.pfadd.ss  f7, f6, f0
            nop
        d.pfmul.ss  f5, f20, f12          // row x, product 0
            st.l    r16, SOURCE(r3)
        d.pfadd.ss  f24, f12, f24
            fld.l   P_ROWS+4(r20), f15
        d.pfmul.ss  f5, f21, f12
            nop
        d.pfadd.ss  f24, f12, f24
            nop
        d.pfmul.ss  f5, f22, f12
            nop
        d.pfadd.ss  f5, f12, f5
            nop
        d.pfadd.ss  f5, f2, f5            // coordinate w
            nop
        d.pfadd.ss  f12, f2, f12
            fld.l   P_ROWS+8(r20), f5
        d.pfadd.ss  f12, f2, f12
            nop
        d.pfmul.ss  f15, f23, f2          // row x, product 1
            nop
        d.pfmul.ss  f15, f25, f24
            fld.l   P_ROWS+12(r20), f12
        d.pfmul.ss  f15, f4, f6
            nop
        d.pfmul.ss  f5, f3, f7            // row x, product 2
            nop
        d.pfadd.ss  f2, f7, f15
            nop
        d.pfmul.ss  f5, f13, f2
            nop
        d.pfadd.ss  f24, f2, f7
            nop
        d.pfmul.ss  f5, f14, f2
            nop
        d.pfadd.ss  f6, f2, f5
            nop
        d.pfmul.ss  f8, f15, f2
            nop
        d.pfadd.ss  f6, f2, f6
            nop
        d.pfmul.ss  f8, f7, f2
            nop
        d.pfadd.ss  f6, f2, f6
            nop
        d.pfmul.ss  f8, f5, f2
            nop
        d.pfadd.ss  f6, f2, f6
            nop
        d.pfadd.ss  f2, f12, f2           // coordinate x
            nop
        d.pfadd.ss  f2, f12, f2
            nop
        d.pfadd.ss  f2, f12, f2
            nop
        d.pfadd.ss  f0, f0, f2
            nop
        d.pfadd.ss  f0, f0, f6
            nop
        d.pfadd.ss  f0, f0, f12
            nop
        d.pfmul.ss  f0, f0, f24
            nop
        d.pfsub.ss  f0, f24, f0
            nop
        d.pfle.ss   f2, f24, f0           // |x| within the guard band
            fst.l   f2, SCRATCH+0(r2)
        d.pfmul.ss  f0, f0, f24
            nop
        d.pfsub.ss  f0, f24, f0
            bc      clipped
        d.pfle.ss   f16, f2, f16
            fst.l   f6, SCRATCH+4(r2)
        d.pfmul.ss  f0, f0, f2
            nop
        d.pfsub.ss  f0, f2, f0
            bc      clipped
        d.pfle.ss   f6, f24, f16
            nop
        d.pfadd.ss  f0, f0, f0
            fst.l   f12, SCRATCH+8(r2)
        d.pfle.ss   f16, f6, f17
            bc      clipped
        d.fnop
            fld.l   P_ROWS+16(r20), f6
        d.pfle.ss   f12, f2, f0
            bc      clipped
        d.pfmul.ss  f9, f15, f0
            fld.l   P_ROWS+20(r20), f2
        d.pfle.ss   f17, f12, f0
            bc      clipped
        d.pfmul.ss  f6, f20, f0           // row y, product 0
            nop
        d.pfmul.ss  f6, f21, f0
            bc      clipped
        d.pfmul.ss  f6, f22, f12
            nop
        d.pfmul.ss  f2, f23, f24          // row y, product 1
            fld.l   P_ROWS+24(r20), f6
        d.pfmul.ss  f2, f25, f16
            nop
        d.pfmul.ss  f2, f4, f18
            fld.l   P_ROWS+28(r20), f17
        d.pfmul.ss  f6, f3, f2            // row y, product 2
            nop
        d.pfadd.ss  f24, f2, f0
            nop
        d.pfmul.ss  f6, f13, f2
            nop
        d.pfadd.ss  f16, f2, f0
            nop
        d.pfmul.ss  f6, f14, f2
            nop
        d.pfadd.ss  f18, f2, f0
            nop
        d.pfmul.ss  f9, f7, f2
            nop
        d.pfadd.ss  f6, f2, f6
            nop
        d.pfmul.ss  f9, f5, f2
            nop
        d.pfadd.ss  f6, f2, f6
            nop
        d.pfsub.ss  f0, f12, f2
            nop
        d.pfadd.ss  f6, f17, f6           // coordinate y
            nop
        d.pfadd.ss  f6, f17, f6
            nop
        d.pfmul.ss  f0, f0, f6
            nop
        d.pfadd.ss  f2, f6, f16
            nop
        d.pfle.ss   f2, f12, f2           // |y| within the guard band
            nop
        d.pfadd.ss  f0, f0, f6
            nop
        d.pfadd.ss  f12, f17, f12
            bc      clipped
        d.pfadd.ss  f0, f0, f0
            nop
        d.pfle.ss   f16, f2, f0
            fst.l   f2, SCRATCH+16(r2)
        d.pfadd.ss  f0, f0, f12
            nop
        d.pfmul.ss  f0, f0, f24
            bc      clipped
        d.pfsub.ss  f0, f24, f0
            nop
        d.pfle.ss   f6, f24, f0
            fst.l   f6, SCRATCH+20(r2)
        d.pfmul.ss  f0, f0, f24
            nop
        d.pfsub.ss  f0, f24, f0
            bc      clipped
        d.pfle.ss   f16, f6, f16
            fst.l   f12, SCRATCH+24(r2)
        d.pfadd.ss  f0, f0, f0
            fld.l   P_ROWS+32(r20), f16
        d.pfle.ss   f12, f24, f17
            bc      clipped
        d.pfle.ss   f17, f12, f0
            bc      clipped
        d.pfmul.ss  f16, f20, f0          // row z, product 0
            fld.l   P_ROWS+36(r20), f17
        d.pfmul.ss  f16, f21, f0
            bc      clipped
        d.pfmul.ss  f16, f22, f0
            nop
        d.pfmul.ss  f17, f23, f22         // row z, product 1
            fld.l   P_ROWS+40(r20), f16
        d.pfmul.ss  f17, f25, f23
            nop
        d.pfmul.ss  f17, f4, f19
            fld.l   P_ROWS+44(r20), f18
        d.pfmul.ss  f16, f3, f4           // row z, product 2
            nop
        d.pfadd.ss  f22, f4, f0
            nop
        d.pfmul.ss  f16, f13, f3
            nop
        d.pfadd.ss  f23, f3, f0
            nop
        d.pfmul.ss  f16, f14, f3
            nop
        d.pfadd.ss  f19, f3, f0
            nop
        d.pfadd.ss  f0, f0, f4
            fld.l   P_TWO_S(r20), f3
        d.pfadd.ss  f0, f0, f13
            nop
        d.pfadd.ss  f0, f0, f14
            nop
        d.pfmul.ss  f0, f0, f19
            nop
        d.pfadd.ss  f4, f19, f0
            nop
        d.pfmul.ss  f0, f0, f4
            nop
        d.pfadd.ss  f13, f4, f0
            nop
        d.pfmul.ss  f0, f0, f4
            nop
        d.pfadd.ss  f14, f4, f0
            nop
        d.pfadd.ss  f4, f18, f4           // coordinate z
            nop
        d.pfadd.ss  f4, f18, f4
            nop
        d.pfadd.ss  f4, f18, f4
            nop
        d.frcp.ss   f15, f2               // seeds of 1 / w
            nop
        d.frcp.ss   f7, f6
            nop
        d.frcp.ss   f5, f12
            nop
        d.pfmul.ss  f15, f2, f0           // a Newton step in single
            nop
        d.pfmul.ss  f7, f6, f0
            nop
        d.pfmul.ss  f5, f12, f0
            nop
        d.pfle.ss   f0, f4, f4            // between near and far
            nop
        d.pfmul.ss  f0, f0, f13
            fst.l   f4, SCRATCH+32(r2)
        d.pfle.ss   f4, f15, f14
            bc      clipped
        d.pfsub.ss  f3, f13, f4
            fst.l   f14, SCRATCH+36(r2)
        d.pfle.ss   f0, f14, f0
            bc      clipped
        d.pfmul.ss  f0, f0, f13
            fst.l   f4, SCRATCH+40(r2)
        d.pfle.ss   f14, f7, f0
            bc      clipped
        d.pfsub.ss  f3, f13, f14
            nop
        d.pfle.ss   f0, f4, f0
            bc      clipped
        d.pfmul.ss  f2, f14, f13
            nop
        d.pfle.ss   f4, f5, f0
            bc      clipped
        d.pfsub.ss  f3, f13, f2
            nop
        d.pfmul.ss  f6, f2, f0
            bc      clipped
        d.pfle.ss   f10, f15, f0          // w in range
            nop
        d.pfamov.sd f15, f0               // to double
            nop
        d.pfle.ss   f15, f11, f4
            bc      clipped
        d.pfmul.ss  f12, f4, f0
            nop
        d.pfle.ss   f10, f7, f0
            bc      clipped
        d.pfamov.sd f7, f12
            fld.d   P_TWO(r20), f2
        d.pfle.ss   f7, f11, f0
            bc      clipped
        d.pfamov.sd f5, f0
            nop
        d.pfle.ss   f10, f5, f6
            bc      clipped
        d.pfmul.ss  f0, f0, f4
            nop
        d.pfle.ss   f5, f11, f0
            bc      clipped
        d.pfamov.sd f4, f8
            nop
        d.pfmul.ss  f0, f0, f4
            bc      clipped
        d.pfamov.sd f4, f0
            nop
        d.pfmul.ss  f0, f0, f4
            nop
        d.pfamov.sd f4, f0
            nop
        d.pfadd.ss  f0, f0, f4
            nop
        d.pfmul.dd  f12, f4, f0           // a Newton step in double
            nop
        d.pfadd.ss  f0, f0, f10
            nop
        d.pfmul.dd  f6, f10, f0
            nop
        d.pfadd.ss  f0, f0, f14
            nop
        d.pfmul.dd  f8, f14, f16
            nop
        d.pfsub.dd  f2, f16, f0
            nop
        d.pfmul.dd  f0, f0, f16
            nop
        d.pfsub.dd  f2, f16, f0
            nop
        d.pfmul.dd  f0, f0, f16
            nop
        d.pfsub.dd  f2, f16, f0
            nop
        d.pfadd.ss  f0, f0, f16
            nop
        d.pfmul.dd  f4, f16, f0
            nop
        d.pfadd.ss  f0, f0, f18
            fld.l   SCRATCH+0(r2), f16
        d.pfmul.dd  f10, f18, f0
            nop
        d.pfadd.ss  f0, f0, f18
            fld.l   SCRATCH+4(r2), f17
        d.pfmul.dd  f14, f18, f20
            nop
        d.fnop
            fld.l   SCRATCH+8(r2), f18
        d.pfmul.dd  f12, f20, f22         // a Newton step in double
            nop
        d.fnop
            fld.l   SCRATCH+16(r2), f19
        d.pfmul.dd  f6, f22, f12
            nop
        d.pfmul.dd  f8, f12, f6
            nop
        d.pfsub.dd  f2, f6, f0
            fld.l   SCRATCH+20(r2), f8
        d.pfmul.dd  f0, f0, f6
            fld.l   SCRATCH+24(r2), f9
        d.pfsub.dd  f2, f6, f0
            fld.l   SCRATCH+32(r2), f24
        d.pfmul.dd  f0, f0, f6
            fld.l   SCRATCH+36(r2), f25
        d.pfsub.dd  f2, f6, f0
            nop
        d.pfadd.ss  f0, f0, f6
            fld.l   SCRATCH+40(r2), f2
        d.pfmul.dd  f20, f6, f0
            nop
        d.pfadd.ss  f0, f0, f6
            fld.q   P_SCREEN(r20), f28
        d.pfmul.dd  f22, f6, f0
            nop
        d.pfadd.ss  f0, f0, f6
            fld.l   P_ROUND_S(r20), f3
        d.pfmul.dd  f12, f6, f20
            nop
        d.pfamov.ds f20, f0               // 1 / w
            nop
        d.pfmul.dd  f0, f0, f6
            nop
        d.pfamov.ds f6, f0
            nop
        d.pfmul.dd  f0, f0, f6
            nop
        d.pfamov.ds f6, f0
            nop
        d.pfadd.ss  f0, f0, f6
            nop
        d.pfmul.ss  f16, f6, f0           // x / w
            nop
        d.pfmul.ss  f19, f6, f0           // y / w
            nop
        d.pfmul.ss  f24, f6, f0           // z / w
            nop
        d.pfadd.ss  f0, f0, f16
            nop
        d.pfmul.ss  f17, f16, f19
            nop
        d.pfmul.ss  f8, f16, f17
            nop
        d.pfmul.ss  f25, f16, f8
            nop
        d.pfmul.ss  f19, f28, f16         // to the screen, x
            nop
        d.pfmul.ss  f28, f16, f19
            nop
        d.pfmul.ss  f17, f29, f16         // to the screen, y
            nop
        d.pfmul.ss  f19, f29, f17
            nop
        d.pfadd.ss  f17, f30, f19
            nop
        d.pfmul.ss  f18, f19, f17
            nop
        d.pfmul.ss  f9, f19, f18
            nop
        d.pfmul.ss  f2, f19, f9
            nop
        d.pfadd.ss  f17, f30, f0
            nop
        d.pfadd.ss  f18, f31, f0
            nop
        d.pfadd.ss  f2, f3, f2            // snapped: integer in the low bits
            nop
        d.pfadd.ss  f2, f3, f2
            nop
        d.pfadd.ss  f9, f31, f2
            nop
        d.pfadd.ss  f2, f3, f6            // snapped: integer in the low bits
            nop
        d.pfsub.ss  f6, f3, f12
            nop
        d.pfadd.ss  f2, f3, f2
            nop
        d.pfsub.ss  f12, f3, f7
            nop
        d.pfamov.sd f2, f2
            nop
        d.pfsub.ss  f7, f3, f13
            nop
        d.pfamov.sd f2, f2
            nop
        d.pfsub.ss  f13, f3, f18
            nop
        d.pfmul.ss  f0, f0, f2
            nop
        d.pfmul.ss  f28, f2, f9
            nop
        d.pfmul.ss  f29, f9, f2
            nop
        d.pfamov.sd f9, f9
            nop
        d.pfmul.ss  f0, f0, f0
            nop
        d.pfmul.ss  f0, f0, f9
            nop
        d.pfadd.ss  f9, f30, f20
            nop
        d.pfamov.sd f9, f9
            fst.d   f18, 0(r3)
        d.pfmul.ss  f0, f0, f9
            nop
        d.pfadd.ss  f9, f31, f4
            nop
        d.pfadd.ss  f9, f3, f9
            nop
        d.fzchkl    f6, f12, f22          // bounding box
            nop
        d.pfadd.ss  f0, f0, f10
            fst.d   f20, 64(r3)
        d.pfadd.ss  f9, f3, f9
            nop
        d.pfsub.ss  f24, f3, f24
            fst.d   f4, 8(r3)
        d.pfsub.dd  f20, f18, f0          // twice the area
            fst.d   f10, 72(r3)
        d.pfsub.ss  f25, f3, f25
            fst.d   f6, 16(r3)
        d.pfamov.sd f3, f3
            nop
        d.fzchkl    f22, f24, f20
            fst.d   f12, 80(r3)
        d.pfsub.dd  f10, f4, f22
            fst.d   f24, 144(r3)
        d.pfamov.sd f3, f3
            nop
        d.pfadd.ss  f0, f0, f10
            nop
        d.pfadd.ss  f0, f0, f26
            fst.d   f10, 128(r3)
        d.pfsub.dd  f14, f4, f14
            fst.d   f20, LOW(r3)
        d.pfsub.dd  f10, f18, f0
            fst.d   f14, 136(r3)
        d.pfamov.sd f8, f0                // depth
            fld.l   P_FLIP(r20), f3
        d.pfamov.sd f16, f4
            nop
        d.pfmul.dd  f22, f4, f0
            nop
        d.fisub.ss  f3, f6, f4
            nop
        d.fisub.ss  f3, f7, f5
            nop
        d.fisub.ss  f3, f12, f6
            nop
        d.fisub.ss  f3, f13, f7
            nop
        d.fisub.ss  f3, f24, f8
            nop
        d.fisub.ss  f3, f25, f9
            nop
        d.fzchkl    f4, f6, f10
            nop
        d.pfamov.sd f2, f6
            fld.d   P_DEPTH(r20), f4
        d.fzchkl    f10, f8, f12
            fld.d   P_NEAR(r20), f2
        d.pfmul.dd  f26, f6, f0
            fld.d   P_HALF(r20), f8
        d.pfadd.ss  f0, f0, f6
            fst.d   f12, HIGH(r3)
        d.pfmul.dd  f4, f6, f12
            fld.d   P_TWO52(r20), f10
        d.pfadd.ss  f0, f0, f6
            nop
        d.pfmul.dd  f4, f6, f14
            nop
        d.pfsub.dd  f12, f14, f6
            nop
        d.pfmul.dd  f4, f6, f12
            nop
        d.pfadd.dd  f12, f2, f0
            nop
        d.pfmul.dd  f0, f0, f4
            nop
        d.pfadd.dd  f4, f2, f0
            nop
        d.pfmul.dd  f0, f0, f4
            nop
        d.pfadd.dd  f4, f2, f6
            nop
        d.pfadd.dd  f2, f8, f2
            fst.d   f6, AREA(r3)
        d.pfadd.dd  f2, f8, f2
            nop
        d.pfadd.dd  f2, f8, f2
            nop
        d.pfadd.dd  f2, f10, f2           // nearest integer
            nop
        d.pfadd.dd  f4, f10, f4
            nop
        d.pfadd.dd  f6, f10, f6
            nop
        d.pfsub.dd  f8, f10, f8
            nop
        d.pfsub.dd  f12, f10, f12
            fst.l   f8, DEPTH+0(r2)
        d.pfsub.dd  f8, f10, f8
            ld.l    DEPTH+0(r2), r31
        d.pfsub.dd  f2, f10, f10          // negative where it was rounded up
            fst.l   f12, DEPTH+16(r2)
        d.pfsub.dd  f4, f2, f2
            ld.l    DEPTH+16(r2), r6
        d.pfsub.dd  f6, f2, f2
            fst.l   f8, DEPTH+32(r2)
        d.pfadd.ss  f0, f0, f2
            ld.l    DEPTH+32(r2), r23
        d.pfadd.ss  f0, f0, f4
            fst.l   f3, DEPTH+8(r2)
        d.pfadd.ss  f0, f0, f2
            ld.l    DEPTH+8(r2), r7
        d.fnop
            fst.l   f5, DEPTH+24(r2)
        d.fnop
            shra    31, r7, r8
        d.fnop
            adds    r8, r31, r9
        d.fnop
            st.l    r9, 32(r3)
        d.fnop
            ld.l    DEPTH+24(r2), r10
        d.fnop
            fst.l   f3, DEPTH+40(r2)
        d.fnop
            shra    31, r10, r12
        d.fnop
            adds    r12, r6, r5
        d.fnop
            st.l    r5, 96(r3)
        d.fnop
            ld.l    DEPTH+40(r2), r13
        d.fnop
            nop
        d.fnop
            shra    31, r13, r14
        fnop
            adds    r14, r23, r15
        fnop
            st.l    r15, 160(r3)
        adds    RECORD_BYTES, r3, r3
passed: adds    TRIANGLE_BYTES, r16, r16
        adds    -1, r17, r17
        adds    -1, r4, r4
        btne    r0, r4, next
        mov     r3, r4
        adds    BATCH, r2, r3
        bte     r3, r4, none

// ---- surfaces: r3 record, r4 end of the records
lighted: ld.l   SOURCE(r3), r5
        call    surface
        adds    40, r3, r6
        adds    RECORD_BYTES, r3, r3
        btne    r3, r4, lighted
        br      second
        adds    BATCH, r2, r3

// ---- not wholly inside the guard band: leave dual-instruction mode, then to the list
        .align  8
clipped: fnop
            nop
        fnop
            nop
        st.l    r16, 0(r21)
        br      passed
        adds    4, r21, r21

// ---- commands: r3 record, r4 end of the records
        .align  32
second: adds    64, r3, r24                 // corners 1 and 2
        adds    128, r3, r25
        fld.d   AREA(r3), f8
        pfgt.dd f8, f0, f0
        bc      oriented
        pfeq.dd f8, f0, f0
        bc      done                        // nothing to draw
        adds    128, r3, r24                // make it clockwise
        adds    64, r3, r25
        fsub.dd f0, f8, f8
        fst.d   f8, AREA(r3)
        .align  8

// ---- edges, pixel of reference, 16 / area
oriented: d.fnop
            nop
        d.fnop
            fld.d   AREA(r3), f2          // area, positive now
        d.fnop
            fld.d   P_TWO(r20), f4
        d.fnop
            ld.l    16(r3), r5
        d.frcp.dd   f2, f6                // seed of 1 / area
            ld.l    20(r3), r6
        d.fnop
            ld.l    16(r24), r7
        d.pfmul.dd  f2, f6, f0            // Newton step 1 for 1 / area
            ld.l    20(r24), r8
        d.fnop
            ld.l    16(r25), r9
        d.pfmul.dd  f0, f0, f0
            ld.l    20(r25), r10
        d.fnop
            subs    r6, r8, r11           // edge 0: a, b
        d.pfmul.dd  f0, f0, f8
            st.l    r11, 8(r18)
        d.pfsub.dd  f4, f8, f0
            subs    r7, r5, r12
        d.pfadd.ss  f0, f0, f0
            st.l    r12, 12(r18)
        d.pfadd.ss  f0, f0, f0
            subs    r0, r11, r13          // a top or a left edge?
        d.pfadd.ss  f0, f0, f8
            shra    31, r13, r14
        d.pfmul.dd  f6, f8, f0
            or      r13, r11, r15
        d.fnop
            shra    31, r15, r22
        d.pfmul.dd  f0, f0, f0
            subs    r0, r12, r23
        d.fnop
            shra    31, r23, r26
        d.pfmul.dd  f2, f6, f6            // Newton step 2 for 1 / area
            andnot  r22, r26, r27
        d.fnop
            or      r27, r14, r28
        d.pfmul.dd  f0, f0, f0
            shl     3, r28, r29
        d.fnop
            adds    r29, r20, r30
        d.pfmul.dd  f0, f0, f10
            fld.d   P_EIGHT(r20), f8
        d.pfsub.dd  f4, f10, f0
            fld.d   0(r3), f12
        d.pfadd.ss  f0, f0, f0
            fld.d   0(r24), f10
        d.pfadd.ss  f0, f0, f0
            fld.d   8(r3), f14
        d.pfsub.dd  f8, f12, f16
            fld.d   8(r24), f18
        d.pfsub.dd  f10, f12, f0          // edge 0: c
            subs    r8, r10, r31          // edge 1: a, b
        d.pfsub.dd  f8, f14, f0
            st.l    r31, 24(r18)
        d.pfsub.dd  f18, f14, f8
            subs    r9, r7, r11
        d.pfmul.dd  f6, f16, f0
            st.l    r11, 28(r18)
        d.pfadd.ss  f0, f0, f6
            subs    r0, r31, r13          // a top or a left edge?
        d.pfadd.ss  f0, f0, f10
            shra    31, r13, r15
        d.pfmul.dd  f6, f10, f0
            or      r13, r31, r12
        d.pfadd.ss  f0, f0, f10
            shra    31, r12, r23
        d.pfmul.dd  f8, f10, f12
            subs    r0, r11, r22
        d.fnop
            shra    31, r22, r26
        d.pfmul.dd  f2, f12, f8           // Newton step 3 for 1 / area
            andnot  r23, r26, r14
        d.fnop
            or      r14, r15, r27
        d.pfmul.dd  f0, f0, f2
            shl     3, r27, r28
        d.pfsub.dd  f8, f2, f0
            adds    r28, r20, r29
        d.pfadd.ss  f0, f0, f0
            fld.d   P_EIGHT(r20), f2
        d.pfadd.ss  f0, f0, f0
            fld.d   0(r24), f8
        d.pfadd.ss  f0, f0, f14
            fld.d   0(r25), f16
        d.pfmul.dd  f0, f0, f18
            fld.d   8(r24), f20
        d.pfsub.dd  f2, f8, f0
            fld.d   8(r25), f22
        d.pfsub.dd  f16, f8, f0           // edge 1: c
            subs    r10, r6, r8           // edge 2: a, b
        d.pfsub.dd  f2, f20, f0
            st.l    r8, 40(r18)
        d.pfsub.dd  f22, f20, f2
            subs    r5, r9, r7
        d.pfsub.dd  f4, f18, f8
            st.l    r7, 44(r18)
        d.pfadd.ss  f0, f0, f4
            subs    r0, r8, r31           // a top or a left edge?
        d.pfmul.dd  f8, f4, f0
            shra    31, r31, r13
        d.pfadd.ss  f0, f0, f4
            or      r31, r8, r12
        d.pfmul.dd  f2, f4, f0
            shra    31, r12, r11
        d.pfadd.ss  f0, f0, f2
            subs    r0, r7, r22
        d.pfmul.dd  f12, f2, f4
            shra    31, r22, r23
        d.fnop
            andnot  r11, r23, r26
        d.pfmul.dd  f0, f0, f2
            or      r26, r13, r15
        d.pfsub.dd  f4, f2, f0
            shl     3, r15, r14
        d.pfadd.ss  f0, f0, f0
            adds    r14, r20, r27
        d.pfadd.ss  f0, f0, f0
            fld.d   P_EIGHT(r20), f2
        d.pfadd.ss  f0, f0, f4
            fld.d   0(r25), f8
        d.pfmul.dd  f0, f0, f12
            fld.d   0(r3), f16
        d.fnop
            fld.d   8(r25), f18
        d.pfsub.dd  f2, f8, f0
            fld.d   8(r3), f20
        d.pfsub.dd  f8, f16, f0           // edge 2: c
            fld.d   P_TIE_OUT(r30), f22
        d.pfsub.dd  f2, f18, f0
            fld.d   P_TIE_OUT(r29), f8
        d.pfsub.dd  f18, f20, f16
            fld.d   P_TIE_OUT(r27), f2
        d.pfadd.dd  f14, f22, f18         // top and left edges own their pixels
            fld.d   P_SIXTEENTH(r20), f20
        d.pfadd.dd  f4, f8, f22           // top and left edges own their pixels
            fld.d   P_ROUND(r20), f14
        d.pfmul.dd  f18, f22, f0
            ld.l    LOW(r3), r28          // bounding box to integers
        d.pfadd.ss  f0, f0, f4
            ld.l    LOW+4(r3), r6
        d.pfmul.dd  f16, f4, f0
            ld.l    HIGH(r3), r10
        d.pfadd.ss  f0, f0, f8
            ld.l    HIGH+4(r3), r5
        d.pfmul.dd  f20, f8, f16
            orh     0x4B40, r0, r9
        d.pfadd.ss  f0, f0, f8
            orh     0x4BC0, r0, r8
        d.pfmul.dd  f20, f8, f22
            subs    r28, r9, r31
        d.pfsub.dd  f22, f16, f0
            st.l    r31, BOX+0(r2)
        d.pfadd.ss  f0, f0, f0
            subs    r6, r9, r12
        d.pfadd.ss  f0, f0, f0
            st.l    r12, BOX+8(r2)
        d.pfadd.dd  f8, f2, f8            // top and left edges own their pixels
            subs    r8, r10, r7
        d.pfadd.ss  f0, f0, f0
            st.l    r7, BOX+4(r2)
        d.pfadd.ss  f0, f0, f0
            subs    r8, r5, r22
        d.pfadd.ss  f0, f0, f2
            st.l    r22, BOX+12(r2)
        d.pfmul.dd  f20, f2, f8
            or      10239, r0, r11
        d.pfadd.dd  f8, f14, f0
            shra    31, r31, r23          // within the picture
        d.pfmul.dd  f0, f0, f2
            andnot  r23, r31, r13
        d.pfadd.dd  f2, f14, f0
            subs    r11, r13, r26
        d.pfmul.dd  f0, f0, f2
            shra    31, r26, r15
        d.pfadd.dd  f2, f14, f0
            and     r15, r26, r14
        d.pfadd.ss  f0, f0, f2
            adds    r14, r13, r30
        d.pfadd.ss  f0, f0, f8
            fst.l   f2, 16(r18)
        d.pfadd.ss  f0, f0, f2
            fst.l   f8, 32(r18)
        d.fnop
            fst.l   f2, 48(r18)
        d.fnop
            shra    31, r7, r29           // within the picture
        d.fnop
            andnot  r29, r7, r27
        d.fnop
            subs    r11, r27, r28
        d.fnop
            shra    31, r28, r6
        d.fnop
            and     r6, r28, r9
        d.fnop
            adds    r9, r27, r10
        d.fnop
            adds    r30, r10, r5
        d.fnop
            shra    5, r5, r8
        d.fnop
            st.l    r8, REFX(r2)
        d.fnop
            or      7679, r0, r31
        d.fnop
            shra    31, r12, r23          // within the picture
        d.fnop
            andnot  r23, r12, r26
        d.fnop
            subs    r31, r26, r15
        d.fnop
            shra    31, r15, r13
        d.fnop
            and     r13, r15, r14
        d.fnop
            adds    r14, r26, r7
        d.fnop
            shra    31, r22, r29          // within the picture
        d.fnop
            andnot  r29, r22, r11
        d.fnop
            subs    r31, r11, r28
        d.fnop
            shra    31, r28, r6
        d.fnop
            and     r6, r28, r27
        d.fnop
            adds    r27, r11, r9
        d.fnop
            adds    r7, r9, r30
        d.fnop
            shra    5, r30, r10
        d.fnop
            st.l    r10, REFY(r2)
        d.fnop
            fld.d   P_TWO52(r20), f2
        d.fnop
            fld.d   P_HALF(r20), f8
        d.fnop
            fld.d   REFX(r2), f14
        d.fnop
            fld.d   0(r3), f16
        d.fnop
            fld.d   P_SIXTEENTH(r20), f20
        d.pfsub.dd  f14, f2, f0           // pixel of reference, x
            fld.d   REFY(r2), f22
        d.pfadd.ss  f0, f0, f0
            fld.d   8(r3), f14
        d.pfmul.dd  f16, f20, f0
            fld.d   P_SIXTEENTH(r20), f24
        d.pfsub.dd  f22, f2, f0           // pixel of reference, y
            fld.d   P_SIXTEEN(r20), f16
        d.pfadd.dd  f20, f8, f20
            fld.d   P_HEADS(r20), f2      // instruction head
        d.pfmul.dd  f14, f24, f0
            fst.d   f20, KEEP+0(r2)
        d.pfadd.ss  f0, f0, f0
            ld.l    P_HEADS+8(r20), r5    // instruction head
        d.pfadd.dd  f14, f8, f14
            fst.d   f2, 0(r18)
        d.pfmul.dd  f12, f16, f2          // 16 / area
            fst.d   f14, KEEP+8(r2)
        d.pfsub.dd  f8, f2, f8
            st.l    r5, 52(r18)
        d.pfadd.ss  f0, f0, f0
            ld.l    P_HEADS+12(r20), r8   // instruction head
        d.pfadd.ss  f0, f0, f2
            ld.l    P_HEADS+16(r20), r12  // instruction head
        d.pfmul.dd  f0, f0, f8
            st.l    r8, 68(r18)
        d.pfsub.dd  f2, f8, f12
            st.l    r12, 72(r18)
        d.pfadd.ss  f0, f0, f0
            fst.d   f12, KEEP+16(r2)
        d.pfadd.ss  f0, f0, f0
            ld.l    P_HEADS+20(r20), r23  // instruction head
        d.pfadd.ss  f0, f0, f2
            ld.l    P_HEADS+24(r20), r15  // instruction head
        d.pfmul.dd  f0, f0, f8
            fst.d   f2, KEEP+24(r2)
        d.fnop
            st.l    r23, 88(r18)
        d.fnop
            st.l    r15, 104(r18)
        d.fnop
            ld.l    P_HEADS+4(r20), r13   // instruction head
        d.fnop
            ld.l    P_HEADS+4(r20), r26   // instruction head
        d.fnop
            st.l    r13, 20(r18)
        d.fnop
            st.l    r26, 36(r18)
        d.fnop
            fst.d   f6, STEP_X0(r2)
        d.fnop
            fst.d   f10, STEP_Y0(r2)
        d.fnop
            fst.d   f18, STEP_X2(r2)
        fnop
            fst.d   f4, STEP_Y2(r2)
        fnop
            fst.d   f8, PERPIX(r2)
        mov     r3, r13                     // planes: depth and red, then green and blue
        mov     r24, r14
        mov     r25, r15
        adds    56, r18, r22
        adds    76, r18, r23
        mov     r20, r26                    // the bias of the upper plane: depth, then surface
        .align  8

// ---- two planes at a time: of each corner's doubles at 32 and 40 of r13, r14, r15
planes: d.fnop
            nop
        d.fnop
            fld.d   32(r13), f2
        d.fnop
            fld.d   40(r13), f4
        d.fnop
            fld.d   32(r14), f6
        d.fnop
            fld.d   40(r14), f8
        d.fnop
            fld.d   32(r15), f10
        d.pfsub.dd  f6, f2, f0            // from corner to corner
            fld.d   40(r15), f12
        d.pfsub.dd  f8, f4, f0
            fld.d   STEP_Y2(r2), f6
        d.pfsub.dd  f10, f2, f0
            fld.d   STEP_Y0(r2), f8
        d.pfsub.dd  f12, f4, f10
            fld.d   STEP_X0(r2), f14
        d.pfmul.dd  f6, f10, f0
            fld.d   STEP_X2(r2), f12
        d.pfadd.ss  f0, f0, f18
            fld.d   PERPIX(r2), f16
        d.pfmul.dd  f6, f18, f0
            fld.d   P_ROUND(r20), f20
        d.pfadd.ss  f0, f0, f22
            fld.d   P_TWO52(r26), f6
        d.pfmul.dd  f8, f22, f24
            nop
        d.pfadd.ss  f0, f0, f26
            nop
        d.pfmul.dd  f8, f26, f28
            nop
        d.pfsub.dd  f2, f6, f0
            nop
        d.pfmul.dd  f22, f14, f2
            fld.d   P_SURFACE(r20), f6
        d.pfsub.dd  f24, f2, f0
            nop
        d.pfmul.dd  f26, f14, f2
            nop
        d.pfsub.dd  f28, f2, f0
            nop
        d.pfmul.dd  f10, f12, f2
            nop
        d.pfsub.dd  f4, f6, f8
            nop
        d.pfmul.dd  f18, f12, f6
            fld.d   KEEP+16(r2), f4
        d.pfadd.ss  f0, f0, f12
            fld.d   KEEP+24(r2), f10
        d.pfmul.dd  f16, f12, f18         // slope along x
            fld.d   KEEP(r2), f14
        d.pfsub.dd  f2, f18, f12
            nop
        d.pfmul.dd  f16, f12, f18
            fld.d   KEEP+8(r2), f2
        d.pfsub.dd  f6, f18, f12
            nop
        d.pfadd.ss  f0, f0, f0
            nop
        d.pfadd.ss  f0, f0, f6
            nop
        d.pfmul.dd  f16, f6, f18          // slope along y
            nop
        d.pfadd.dd  f18, f20, f6
            nop
        d.pfmul.dd  f16, f6, f22
            nop
        d.pfadd.dd  f22, f20, f0
            nop
        d.pfmul.dd  f18, f4, f6
            nop
        d.pfadd.dd  f6, f20, f0
            nop
        d.pfmul.dd  f22, f4, f16
            nop
        d.pfadd.dd  f16, f20, f4
            nop
        d.pfsub.dd  f4, f20, f18
            fst.l   f4, 0(r22)
        d.pfsub.dd  f18, f20, f4
            fst.l   f18, 0(r23)
        d.pfsub.dd  f4, f20, f18
            fst.l   f4, 4(r22)
        d.pfsub.dd  f18, f20, f4
            fst.l   f18, 4(r23)
        d.pfmul.dd  f6, f10, f18
            nop
        d.pfadd.dd  f8, f18, f6           // value at the pixel of reference
            nop
        d.pfmul.dd  f16, f10, f8
            nop
        d.pfadd.dd  f12, f8, f10
            nop
        d.pfmul.dd  f4, f14, f8
            nop
        d.pfadd.ss  f0, f0, f4
            nop
        d.pfmul.dd  f6, f14, f12
            nop
        d.pfadd.dd  f6, f8, f6
            nop
        d.pfmul.dd  f10, f2, f6
            nop
        d.pfadd.dd  f8, f12, f8
            nop
        d.pfmul.dd  f4, f2, f8
            nop
        d.pfadd.ss  f0, f0, f0
            nop
        d.pfadd.dd  f2, f20, f2
            nop
        d.pfadd.dd  f2, f20, f2
            nop
        d.pfmul.dd  f0, f0, f2
            nop
        d.pfadd.dd  f6, f2, f0
            nop
        d.pfmul.dd  f0, f0, f2
            nop
        d.pfadd.dd  f8, f2, f4
            nop
        d.pfadd.ss  f0, f0, f2
            nop
        d.pfadd.dd  f6, f20, f6
            nop
        d.pfadd.dd  f6, f20, f6
            nop
        d.pfadd.ss  f0, f0, f0
            nop
        d.pfadd.ss  f0, f0, f6
            nop
        d.fisub.ss  f4, f6, f8            // back to pixel 0, 0
            nop
        d.pfadd.ss  f0, f0, f4
            nop
        d.fisub.ss  f2, f4, f9            // back to pixel 0, 0
            fst.l   f8, 8(r22)
        fnop
            nop
        fnop
            fst.l   f9, 8(r23)
        adds    16, r13, r13
        adds    16, r14, r14
        adds    16, r15, r15
        adds    36, r22, r22
        adds    32, r23, r23
        adds    P_SURFACE-P_TWO52, r26, r26
        adds    32, r3, r30
        btne    r13, r30, planes
        call    bins
        nop
        bte     r0, r22, done               // no region: the next command overwrites this one
        ld.l    SOURCE(r3), r5
        finish  r5
        restate
        adds    COMMAND_BYTES, r18, r18
done:   adds    RECORD_BYTES, r3, r3
        btne    r3, r4, second
none:   btne    r0, r17, batch
        ld.l    SAVE(r2), r1
        nop
        bri     r1
        nop
