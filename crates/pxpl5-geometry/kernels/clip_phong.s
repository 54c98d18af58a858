// What the clipper interpolates of Phong triangles: the normals of their corners in eye coordinates, in units of the command's normal.

        .macro  extras
        sided   VERTICES+V_AWAY, V_BYTES
        st.l    r8, SIDE(r2)
        mov     r16, r5
        adds    VERTICES, r2, r6
        mov     3, r4
normal: fld.l   NORMAL(r5), f20
        fld.l   NORMAL+4(r5), f21
        fld.l   NORMAL+8(r5), f22
        adds    V_EXTRA, r6, r10
        mov     r20, r11
        mov     3, r9
axis:   alongaxis
        fst.l   f16, 0(r10)
        adds    4, r10, r10
        btne    r0, r9, axis
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        adds    V_BYTES, r6, r6
        btne    r0, r4, normal
        .endm
