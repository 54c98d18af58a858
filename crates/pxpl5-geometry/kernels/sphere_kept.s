// There are no bins of spheres: the box of each command goes to r19, in pixels of the picture.

        .macro  boxed
        st.l    r11, 0(r19)
        st.l    r12, 4(r19)
        st.l    r13, 8(r19)
        st.l    r14, 12(r19)
        adds    16, r19, r19
        .endm

        .macro  binned
        .endm
