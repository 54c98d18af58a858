// Computes the screen positions of triangles' corners in one of two views (kernels/between_rules.md of pphigs, rule 1).
//
// In: r16 first triangle, r17 number of triangles (at least 1), r18 records of the triangles, r20 parameter block, r21
// 0 for the first view or 48 for the second view.

        .align  32
keepends: mov   r16, r5
        adds    E_CORNERS, r18, r6
        adds    r21, r6, r6
        mov     3, r4
        mov     1, r3
        orh     0x7FFF, r0, r11
        subs    r0, r11, r12
        bte     r0, r21, each
        ld.l    E_INSIDE(r18), r3
        ld.l    E_TOP(r18), r11
        ld.l    E_BOTTOM(r18), r12
        bte     r0, r3, noted
each:   projected
        guarded
        placed
        fsub.dd f12, f10, f12
        fst.d   f12, E_DEPTH(r6)
        ftrunc.sd f21, f18
        fxfr    f18, r10
        subs    r10, r11, r0
        bnc     low                         // unless the least number is greater
        mov     r10, r11
low:    subs    r12, r10, r0
        bnc     high
        mov     r10, r12
high:   adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        adds    E_CORNER, r6, r6
        btne    r0, r4, each
noted:  st.l    r3, E_INSIDE(r18)
        st.l    r11, E_TOP(r18)
        st.l    r12, E_BOTTOM(r18)
        adds    -1, r17, r17
        adds    TRIANGLE_BYTES, r16, r16
        adds    E_BYTES, r18, r18
        btne    r0, r17, keepends
        bri     r1
        nop
beyond: br      noted
        mov     r0, r3

// Interpolates matrices between two views, element by element (kernels/between_rules.md of pphigs, rule 2).
//
// In: r16 matrices of the first view, r17 matrices of the second view, r18 destination, r19 number of elements (at
// least 1), r20 and r21 fraction of the way between the views as a double.

        .align  32
blend:  ixfr    r20, f16
        ixfr    r21, f17
        orh     0x3FF0, r0, r22             // 1.0
        ixfr    r0, f18
        ixfr    r22, f19
        nop
        fsub.dd f18, f16, f18
element: fld.l  0(r16), f8
        fld.l   0(r17), f9
        adds    4, r16, r16
        fmov.sd f8, f10
        adds    4, r17, r17
        fmov.sd f9, f12
        adds    -1, r19, r19
        fmul.dd f10, f18, f10
        fmul.dd f12, f16, f12
        fadd.dd f10, f12, f10
        fmov.ds f10, f8
        fst.l   f8, 0(r18)
        adds    4, r18, r18
        btne    r0, r19, element
        bri     r1
        nop
