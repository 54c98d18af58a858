// A command: enable; silhouette, root, depth; normal x and y; its z from the root; the object's colour.
COMMAND_BYTES = 152

        .macro  surface
        fld.d   PEAK_VALUE(r2), f16         // the root at the middle, a quarter of which is z
        call    root
        nop
        fmul.dd f16, f18, f18
        mov     1023, r8
        subs    r8, r25, r8
        shl     20, r8, r8
        ixfr    r0, f8
        ixfr    r8, f9
        fmul.dd f18, f8, f18                // 2^-depth_shift
        fld.d   S_QUARTER(r20), f8
        fld.d   S_UNIT(r20), f10
        fmul.dd f18, f8, f18
        fmul.dd f18, f10, f18
        fst.d   f18, UP(r2)
        fld.d   PER(r2), f8
        fld.d   S_HALF_UNIT(r20), f16
        fmul.dd f18, f8, f18
        fmov.dd f0, f20
        fld.d   PEAK(r2), f22
        fld.d   PEAK+8(r2), f24
        call    plane
        adds    108, r18, r11
        fld.d   UP(r2), f18
        fld.d   PER+8(r2), f8
        fsub.dd f0, f18, f18
        fld.d   S_HALF_UNIT(r20), f16
        fmul.dd f18, f8, f20
        fmov.dd f0, f18
        call    plane
        adds    124, r18, r11
        restated 108
        restated 124
        heads   26, 30
        heads   34, 35
        ld.l    S_WORDS+144(r20), r8
        ld.l    COLOUR(r16), r9
        st.l    r8, 144(r18)
        st.l    r9, 148(r18)
        .endm
