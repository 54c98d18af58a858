        .macro  restated_after
        .endm
        d.fnop
            btne    r22, r0, slow
        d.fnop
            st.l    r18, 0(r7)
        d.fnop
            adds    4, r7, r7
        d.fnop
            st.l    r7, 0(r23)
