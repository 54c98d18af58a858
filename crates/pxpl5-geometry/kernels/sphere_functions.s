// What the code of spheres calls.

// ---- f18 = 1 / the root of f16. Changes f8, f20, f22.
root:   fld.d   S_HALF(r20), f20
        fld.d   S_THREE_HALVES(r20), f22
        nop
        reciprocal_root
        bri     r1
        nop

// ---- f12 = the conic, whose coefficients are in f16 to f26, at f8, f10 from its origin. Changes f14.
value:  fmul.dd f16, f8, f12
        fmul.dd f18, f10, f14
        fadd.dd f12, f14, f12
        fadd.dd f12, f22, f12
        fmul.dd f12, f8, f12
        fmul.dd f20, f10, f14
        fadd.dd f14, f24, f14
        fmul.dd f14, f10, f14
        fadd.dd f12, f14, f12
        bri     r1
        fadd.dd f12, f26, f12

// ---- plane of value f16 and slopes f18, f20 at the pixel f22, f24 to the words at r11. Keeps r4, r9, r10, f22 to f26, f30.
plane:  fld.d   S_LIMIT(r20), f28
        fsub.dd f0, f18, f8
        pfgt.dd f28, f18, f0
        bnc     level
        pfgt.dd f28, f8, f0
        bnc     level
        fsub.dd f0, f20, f8
        pfgt.dd f28, f20, f0
        bnc     level
        pfgt.dd f28, f8, f0
        bnc     level
        fld.d   PIXEL(r2), f8
        fsub.dd f8, f22, f8
        fld.d   PIXEL+8(r2), f10
        fsub.dd f10, f24, f10
        fmul.dd f18, f8, f8
        fld.d   S_ROUND(r20), f12
        fadd.dd f16, f8, f16
        fmul.dd f20, f10, f10
        fadd.dd f16, f10, f16
        fadd.dd f18, f12, f18
        fld.d   PIXEL_X(r2), f8
        fadd.dd f20, f12, f20
        fld.d   PIXEL_Y(r2), f10
        fadd.dd f16, f12, f16
        fxfr    f18, r6
        fmlow.dd f18, f8, f8
        fxfr    f20, r7
        st.l    r6, 0(r11)
        fmlow.dd f20, f10, f10
        st.l    r7, 4(r11)
        fxfr    f8, r6
        fxfr    f10, r7
        fxfr    f16, r8
        adds    r6, r7, r6
        subs    r8, r6, r8
        bri     r1
        st.l    r8, 8(r11)
level:  fld.d   S_ROUND(r20), f12
        st.l    r0, 0(r11)
        fadd.dd f16, f12, f16
        st.l    r0, 4(r11)
        fxfr    f16, r8
        bri     r1
        st.l    r8, 8(r11)
