// Normals at the corners of the compiled kernel.

// on the whole turned away? P_SIDES or the place behind it in r8
        .macro  surfaces
        sided   CORNERS+C_AWAY, C_BYTES
        mov     r16, r5
        adds    CORNERS, r2, r6
        mov     3, r4
normals: call   normal
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, normals
        .endm

// ---- normal: vertex at r5 to the values of the structure at r6, and r6 to the next; the side at r8
normal: fld.l   NORMAL(r5), f20
        fld.l   NORMAL+4(r5), f21
        fld.l   NORMAL+8(r5), f22
        adds    C_SURFACE, r6, r10
        mov     r20, r11
        mov     3, r9
        fld.l   P_SIDES+8(r8), f10
        fld.d   P_SIDES+16(r8), f12
        fld.l   P_ROUND_S(r20), f9
axis:   alongaxis
        fadd.ss f16, f9, f16
        fmul.sd f16, f10, f18
        fadd.dd f18, f12, f18
        fst.d   f18, 0(r10)
        adds    8, r10, r10
        btne    r0, r9, axis
        adds    C_BYTES, r6, r6
        bri     r1
        nop
