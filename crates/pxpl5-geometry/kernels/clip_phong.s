// What the clipper interpolates of Phong triangles: the normals of their corners in eye coordinates, in units of the command's normal.

        .macro  extras
        fld.l   VERTICES+V_AWAY(r2), f8     // on the whole turned away?
        fld.l   VERTICES+V_BYTES+V_AWAY(r2), f9
        fld.l   VERTICES+2*V_BYTES+V_AWAY(r2), f10
        fadd.ss f8, f9, f8
        mov     r20, r8
        fadd.ss f8, f10, f8
        pfgt.ss f8, f0, f0
        bnc     facing
        adds    24, r20, r8
facing: st.l    r8, SIDE(r2)
        mov     r16, r5
        adds    VERTICES, r2, r6
        mov     3, r4
normal: fld.l   NORMAL(r5), f20
        fld.l   NORMAL+4(r5), f21
        fld.l   NORMAL+8(r5), f22
        adds    V_EXTRA, r6, r10
        mov     r20, r11
        mov     3, r9
axis:   fld.l   P_EYE(r11), f16
        fld.l   P_EYE+4(r11), f17
        fld.l   P_EYE+8(r11), f18
        adds    -1, r9, r9
        fmul.ss f16, f20, f16
        fmul.ss f17, f21, f17
        fadd.ss f16, f17, f16
        fmul.ss f18, f22, f18
        adds    16, r11, r11
        fadd.ss f16, f18, f16
        fst.l   f16, 0(r10)
        adds    4, r10, r10
        btne    r0, r9, axis
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        adds    V_BYTES, r6, r6
        btne    r0, r4, normal
        .endm
