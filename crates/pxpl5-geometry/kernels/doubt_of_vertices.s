        for i 0 1 2
        st.l qi$i, RECORD*$i+R_DOUBT(r6)
begins$i = ld.l 32*$i+BEGINS(r29)
        st.l begins$i, RECORD*$i+R_BEGINS(r6)
        endfor
        .endlinear
