// Surfaces for Gouraud shading: lit colours of the corners, 0 to 255 in units of 1/4096, and half a unit.

// A command: enable; three edges; depth compared, depth loaded again; red, green, blue.
COMMAND_BYTES = 120

// Nothing follows the planes.
        .macro  finish triangle
        .endm

// the cosine c of the light, of the normal's other side where it turns away by d; at least 0
        .macro  cosine d, c
        pfgt.ss \d, f0, f0
        bnc     facing\@
        fsub.ss f0, \c, \c
facing\@: pfgt.ss \c, f0, f0
        bc      lit\@
        fmov.ss f0, \c
lit\@:  nop
        .endm

// 0 to 1
        .macro  within s
        pfle.ss f0, \s, f0
        bnc     least\@
        fmov.ss f0, \s
least\@: pfgt.ss \s, f6, f0
        bnc     most\@
        fmov.ss f6, \s
most\@: nop
        .endm

// 256 times 8 bits of a colour, by way of 2^23
        .macro  eight shift, colour, to
        shr     \shift, \colour, r11
        and     255, r11, r11
        shl     8, r11, r11
        or      r10, r11, r11
        ixfr    r11, \to
        .endm

        .macro  leave from, at
        fxfr    \from, r11
        shl     4, r11, r11
        adds    r14, r11, r11
        st.l    r11, \at(r6)
        .endm

        .macro  component k
        eight   16-8*\k, r7, f12
        eight   16-8*\k, r8, f13
        eight   16-8*\k, r9, f14
        three   pfsub.ss, f12, f4, f13, f4, f14, f4, f12, f13, f14
        three   pfmul.ss, f12, f8, f13, f9, f14, f10, f12, f13, f14
        three   pfadd.ss, f12, f5, f13, f5, f14, f5, f12, f13, f14
        leave   f12, SURFACE_WORD*\k
        leave   f13, SURFACE_WORD*\k+SURFACE_CORNER
        leave   f14, SURFACE_WORD*\k+2*SURFACE_CORNER
        .endm

// In: r5 triangle, r6 where the words go. Changes r7 to r14 and all floating-point registers.
        .align  32
surface: normals
        fld.l   P_LIGHT(r20), f16
        fld.l   P_LIGHT+4(r20), f17
        fld.l   P_LIGHT+8(r20), f18
        weighted f16, f17, f18, f4, f8, f12, f5, f9, f13, f6, f10, f14, f26, f27, f28
        fmov.ss f26, f8
        fmov.ss f27, f9
        fmov.ss f28, f10
        cosine  f11, f8
        cosine  f15, f9
        cosine  f19, f10
        fld.l   P_AMBIENT(r20), f4
        fld.l   P_DIFFUSE(r20), f5
        fld.l   P_ONE(r20), f6
        three   pfmul.ss, f5, f8, f5, f9, f5, f10, f8, f9, f10
        three   pfadd.ss, f4, f8, f4, f9, f4, f10, f8, f9, f10
        within  f8
        within  f9
        within  f10
        ld.l    COLOUR(r5), r7
        ld.l    COLOUR+32(r5), r8
        ld.l    COLOUR+64(r5), r9
        orh     0x4B00, r0, r10             // bits of 2^23
        mov     0x4C000800, r14             // - 16 * bits of 1.5 * 2^23 + half a unit
        fld.l   P_TWO23(r20), f4
        fld.l   P_ROUND_S(r20), f5
        component 0
        component 1
        component 2
        bri     r1
        nop
