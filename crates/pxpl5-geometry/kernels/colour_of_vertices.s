        // of each corner by itself, since triangles share them
        for i 0 1 2
        fst.l ge$i, RECORD*$i+R_SIDE(r6)
colour$i = ld.l 32*$i+COLOUR(r29)
        st.l colour$i, RECORD*$i+R_COLOUR(r6)
        endfor
        prefetch TRIANGLE_BYTES+64(r29) !last
