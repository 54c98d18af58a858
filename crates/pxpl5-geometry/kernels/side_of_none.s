        st.l r0, R_SIDE(r6)
