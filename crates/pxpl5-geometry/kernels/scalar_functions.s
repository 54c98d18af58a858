// Functions of the scalar set-up.

// ---- edge from the corner at r10 to the corner at r11, stored at r12: a = -dy, b = dx, c = floor((dx (8 - y) - dy (8
// - x) - tie) / 16)
edge:   fld.d   C_X(r10), f8
        fld.d   C_X(r11), f10
        orh     0x4100, r0, r13             // 8.0
        ixfr    r13, f12
        fsub.ss f10, f8, f16                // dx
        fsub.ss f11, f9, f17                // dy
        fsub.ss f12, f8, f18
        fsub.ss f12, f9, f19
        fmul.sd f16, f19, f20
        fmul.sd f17, f18, f22
        fsub.dd f20, f22, f20
        ftrunc.sd f16, f22
        fxfr    f22, r13
        ftrunc.sd f17, f22
        fxfr    f22, r14
.if SINGLE
        adds    r13, r13, r13               // a row of the field has two lines
.endif
        st.l    r13, 4(r12)
        subs    r0, r14, r14
        st.l    r14, 0(r12)
        pfgt.ss f0, f17, f0                 // a top or a left edge?
        bc      owned
        pfeq.ss f17, f0, f0
        bnc     foreign
        pfgt.ss f16, f0, f0
        bnc     foreign
owned:  br      tied
        fld.d   P_TIE_IN(r20), f10
foreign: fld.d  P_TIE_OUT(r20), f10
tied:   fld.d   P_SIXTEENTH(r20), f12
        fadd.dd f20, f10, f20
        fld.d   P_ROUND(r20), f14
        fmul.dd f20, f12, f20
        fadd.dd f20, f14, f20
        fxfr    f20, r13
        bri     r1
        st.l    r13, 8(r12)

.if SINGLE
// ---- plane through the values at r10 of the corners r7, r8 and r9, in single precision, stored at r11
plane:  adds    r10, r7, r12
        fld.l   0(r12), f16
        adds    r10, r8, r12
        fld.l   0(r12), f18
        adds    r10, r9, r12
        fld.l   0(r12), f20
        fld.l   DY2(r2), f8
        fsub.ss f18, f16, f18
        fld.l   DY1(r2), f9
        fsub.ss f20, f16, f20
        fld.l   DX1(r2), f10
        fmul.ss f18, f8, f22
        fld.l   DX2(r2), f11
        fmul.ss f20, f9, f24
        fld.l   PERPIX(r2), f12
        fsub.ss f22, f24, f22
        fld.l   PERROW(r2), f13
        fmul.ss f22, f12, f22               // slope along x
        fmul.ss f20, f10, f24
        fmul.ss f18, f11, f26
        fld.l   P_ROUND52_S(r20), f28
        fsub.ss f24, f26, f24
        fld.l   TOX(r2), f14
        fmul.ss f24, f13, f24               // slope along y
        fld.l   TOY(r2), f15
        fadd.sd f22, f28, f8
        fmul.ss f22, f14, f22
        fxfr    f8, r12
        fadd.ss f16, f22, f16
        st.l    r12, 0(r11)
        fadd.sd f24, f28, f10
        fmul.ss f24, f15, f24
        fxfr    f10, r13
        fadd.ss f16, f24, f16               // value at pixel (0, 0)
        st.l    r13, 4(r11)
        fadd.sd f16, f28, f12
        fxfr    f12, r12
        bri     r1
        st.l    r12, 8(r11)
.else
// ---- plane through the values at r10 of the corners r7, r8 and r9, stored at r11
plane:  adds    r10, r7, r12
        fld.d   0(r12), f16
        adds    r10, r8, r12
        fld.d   0(r12), f18
        adds    r10, r9, r12
        fld.d   0(r12), f20
        fld.l   DY2(r2), f8
        fsub.dd f18, f16, f18
        fmov.sd f8, f10
        fld.l   DY1(r2), f9
        fsub.dd f20, f16, f20
        fmov.sd f9, f12
        fmul.dd f18, f10, f22
        fld.l   DX1(r2), f8
        fmul.dd f20, f12, f24
        fld.l   DX2(r2), f9
        fsub.dd f22, f24, f22
        fld.d   PERPIX(r2), f14
        fmul.dd f22, f14, f22               // slope along x
        fmov.sd f8, f10
        fmov.sd f9, f12
        fmul.dd f20, f10, f24
        fmul.dd f18, f12, f26
        fld.d   P_ROUND(r20), f28
        fsub.dd f24, f26, f24
        fld.d   TOX(r2), f18
        fmul.dd f24, f14, f24               // slope along y
        steep
        fld.d   TOY(r2), f20
        fadd.dd f22, f28, f10
        fmul.dd f22, f18, f18
        fxfr    f10, r12
        fadd.dd f24, f28, f12
        st.l    r12, 0(r11)
        fxfr    f12, r13
        fadd.dd f16, f18, f16
        fmul.dd f24, f20, f20
        st.l    r13, 4(r11)
        fld.d   REFX(r2), f22
        fadd.dd f16, f20, f16               // value at the reference pixel
        fld.d   REFY(r2), f24
        fsub.dd f10, f28, f10
        fsub.dd f12, f28, f12
        fmul.dd f10, f22, f10
        fmul.dd f12, f24, f12
        fadd.dd f16, f28, f16
        fadd.dd f10, f12, f10
        fxfr    f16, r12
        fadd.dd f10, f28, f10
        fxfr    f10, r13
        subs    r12, r13, r12
        bri     r1
        st.l    r12, 8(r11)
.endif
