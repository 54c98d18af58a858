colour  = ld.l COLOUR(r29)
        st.l colour, R_COLOUR(r6)
        prefetch TRIANGLE_BYTES+64(r29) !last
