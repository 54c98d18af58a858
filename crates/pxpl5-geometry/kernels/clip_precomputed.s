// What the clipper interpolates of triangles whose colours are precomputed: these, 0 to 255 * 256. No normal is looked at.

        .macro  turnsaway
        .endm

        .macro  extras
        st.l    r20, SIDE(r2)
        mov     r16, r5
        adds    VERTICES, r2, r6
        mov     3, r4
colour: ld.l    COLOUR(r5), r8
        mov     16, r9
        mov     -8, r7
        adds    V_EXTRA, r6, r10
        fld.l   P_TWO23(r20), f8
byte:   shr     r9, r8, r11                 // 256 times 8 bits of the colour, by way of 2^23
        and     255, r11, r11
        shl     8, r11, r11
        orh     0x4B00, r11, r11
        ixfr    r11, f17
        adds    -8, r9, r9
        adds    4, r10, r10
        fsub.ss f17, f8, f17
        fst.l   f17, -4(r10)
        btne    r9, r7, byte                // r7 is the shift behind the last one
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        adds    V_BYTES, r6, r6
        btne    r0, r4, colour
        .endm
