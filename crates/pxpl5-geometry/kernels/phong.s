// Surfaces for Phong shading: normals of the corners, turned over if they face away from the eye on the whole, in
// units of the command's expressions, and half a unit.

// A command: enable; three edges; depth compared, depth loaded again; normal x, y, z; the object's colour.
COMMAND_BYTES = 128

// The colour of the triangle's first corner, and its instruction head
        .macro  finish triangle
        ld.l    P_HEADS+28(r20), r6
        ld.l    COLOUR(\triangle), r7
        st.l    r6, 120(r18)
        st.l    r7, 124(r18)
        .endm

        .macro  leave from, at
        fxfr    \from, r11
        shl     6, r11, r11
        adds    r14, r11, r11
        st.l    r11, \at(r6)
        .endm

        .macro  component k, n0, n1, n2
        three   pfadd.ss, \n0, f5, \n1, f5, \n2, f5, f12, f13, f14
        leave   f12, SURFACE_WORD*\k
        leave   f13, SURFACE_WORD*\k+SURFACE_CORNER
        leave   f14, SURFACE_WORD*\k+2*SURFACE_CORNER
        .endm

// In: r5 triangle, r6 where the words go. Changes r11, r14 and all floating-point registers.
        .align  32
surface: normals
        direction 0, f26, f27, f28
        direction 1, f29, f30, f31
        direction 2, f2, f3, f7
        fadd.ss f11, f15, f4
        fadd.ss f4, f19, f4
        pfgt.ss f4, f0, f0
        bnc     facing
        three   pfsub.ss, f0, f26, f0, f27, f0, f28, f26, f27, f28
        three   pfsub.ss, f0, f29, f0, f30, f0, f31, f29, f30, f31
        three   pfsub.ss, f0, f2, f0, f3, f0, f7, f2, f3, f7
facing: fld.l   P_ROUND_S(r20), f5
        mov     0xB0000200, r14             // - 64 * bits of 1.5 * 2^23 + half a unit + 2^31
        component 0, f26, f27, f28
        component 1, f29, f30, f31
        component 2, f2, f3, f7
        bri     r1
        nop
