// A command: enable; silhouette, root, depth; of three components a product with the root, a linear part, a limit.
COMMAND_BYTES = 212

// the vector f24 f26 f28 the other way round
        .macro  turnedround
        fsub.dd f0, f24, f24
        fsub.dd f0, f26, f26
        fsub.dd f0, f28, f28
        .endm

// the same with length 1
        .macro  unit
        fmul.dd f24, f24, f16
        fmul.dd f26, f26, f8
        fadd.dd f16, f8, f16
        fmul.dd f28, f28, f8
        call    root
        fadd.dd f16, f8, f16
        fmul.dd f24, f18, f24
        fmul.dd f26, f18, f26
        fmul.dd f28, f18, f28
        .endm

// of the vector that is 1 along axis k, what is at a right angle to where the eye lies, unit: its part along the light
        .macro  across k, to
        fld.d   TOWARDS(r2), f24
        fld.d   TOWARDS+8(r2), f26
        fld.d   TOWARDS+16(r2), f28
        fld.d   TOWARDS+8*\k(r2), f30
        fmul.dd f30, f24, f24
        fmul.dd f30, f26, f26
        fmul.dd f30, f28, f28
        turnedround
        fld.d   S_ONE(r20), f8
        oneof\k
        unit
        lit     f24, f26, f28
        fst.d   f24, \to(r2)
        .endm
        .macro  oneof0
        fadd.dd f24, f8, f24
        .endm
        .macro  oneof1
        fadd.dd f26, f8, f26
        .endm

// a = the vector a, b, c times the light
        .macro  lit a, b, c
        fld.d   S_LIGHT(r20), f8
        fld.d   S_LIGHT+8(r20), f10
        fmul.dd \a, f8, \a
        fmul.dd \b, f10, \b
        fadd.dd \a, \b, \a
        fld.d   S_LIGHT+16(r20), f8
        fmul.dd \c, f8, \c
        fadd.dd \a, \c, \a
        .endm

        .macro  surface
        // towards the eye
        ld.l    S_PARALLEL(r20), r8
        fmov.dd f0, f24
        fmov.dd f0, f26
        fld.d   S_ONE(r20), f28
        btne    r0, r8, ahead
        fld.d   CENTRE(r2), f24
        fld.d   CENTRE+8(r2), f26
        fld.d   CENTRE+16(r2), f28
        turnedround
        unit
ahead:  fst.d   f24, TOWARDS(r2)
        fst.d   f26, TOWARDS+8(r2)
        fst.d   f28, TOWARDS+16(r2)
        across  0, ACROSS
        across  1, UP
        fld.d   TOWARDS(r2), f24
        fld.d   TOWARDS+8(r2), f26
        fld.d   TOWARDS+16(r2), f28
        lit     f24, f26, f28
        fst.d   f24, TOWARDS(r2)
        // one over the greatest value of the root's upper bits
        fld.d   PEAK_VALUE(r2), f16
        call    root
        nop
        adds    1027, r25, r8
        shl     20, r8, r8
        ixfr    r0, f8
        ixfr    r8, f9
        fmul.dd f18, f8, f18                // 16 times 2^depth_shift
        fst.d   f18, PER_ROOT(r2)
        orh     0x4330, r0, r30
        adds    112, r18, r10
        adds    COLOUR+2, r16, r9           // red
        mov     3, r4
component: ld.b 0(r9), r8
        fld.d   S_TWO52(r20), f10
        and     255, r8, r8
        ixfr    r8, f28
        ixfr    r30, f29
        fsub.dd f28, f10, f28               // the component
        fld.d   S_DIFFUSE(r20), f30
        fmul.dd f28, f30, f12               // what the root contributes
        fld.d   TOWARDS(r2), f8
        fmul.dd f12, f8, f12
        fld.d   S_256(r20), f8
        fmul.dd f12, f8, f12
        fld.d   PER_ROOT(r2), f8
        fmul.dd f12, f8, f12
        fld.d   S_511(r20), f14
        pfgt.dd f12, f0, f0
        bc      lighter
        fmov.dd f0, f12
lighter: pfgt.dd f14, f12, f0
        bc      darker
        fmov.dd f14, f12
darker: fld.d   S_ROUND(r20), f10
        fld.d   S_UNIT(r20), f26
        fadd.dd f12, f10, f12
        fmul.dd f28, f26, f28
        fxfr    f12, r8
        fld.d   S_AMBIENT(r20), f8
        fmul.dd f28, f8, f16
        fld.d   S_HALF_UNIT(r20), f10
        fmul.dd f28, f30, f28
        st.l    r8, 0(r10)
        fadd.dd f16, f10, f16
        fld.d   ACROSS(r2), f8
        fmul.dd f28, f8, f18
        fld.d   PER(r2), f10
        fmul.dd f18, f10, f18
        fld.d   UP(r2), f8
        fmul.dd f28, f8, f20
        fld.d   PER+8(r2), f10
        fsub.dd f0, f20, f20
        fmul.dd f20, f10, f20
        fld.d   PEAK(r2), f22
        fld.d   PEAK+8(r2), f24
        call    plane
        adds    8, r10, r11
        adds    -1, r9, r9
        adds    -1, r4, r4
        adds    36, r10, r10
        btne    r0, r4, component
        restated 120
        restated 156
        restated 192
        heads   26, 27
        heads   29, 33
        heads   34, 35
        heads   36, 38
        heads   42, 43
        heads   44, 45
        heads   47, 51
        ld.l    S_WORDS+208(r20), r8
        nop
        st.l    r8, 208(r18)
        .endm
