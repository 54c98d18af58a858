        // the precomputed colours at the corners
above   = orh 0x4B40, r0
        for i 0 1 2
ka$i    = ld.l 32*$i+COLOUR(r29)
kb$i    = shr 8, ka$i
kc$i    = shl 8, ka$i
la0$i   = and 0xFF00, kb$i
la1$i   = and 0xFF00, ka$i
la2$i   = and 0xFF00, kc$i
        for k 0 1 2
lb$k$i  = or above, la$k$i
        st.l lb$k$i, RECORD*$i+R_SURFACE+4*$k(r6)
        endfor
        endfor
        prefetch TRIANGLE_BYTES+64(r29)
