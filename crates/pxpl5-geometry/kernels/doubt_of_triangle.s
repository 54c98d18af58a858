qj      = or qi0, qi1
qk      = or qj, qi2
        st.l qk, R_DOUBT(r6)
        .endlinear
