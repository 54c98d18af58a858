        // on the whole turned away? the place in the table of sides
gf      = add.ss ge0, ge1
gg      = add.ss gf, ge2
@gg     fst.l gg, SIDE_WORD(r2)
gh      = ld.l SIDE_WORD(r2) !gg
gi      = shra 31, gh
gj      = subs r0, gh
gk      = shra 31, gj
gl      = andnot gi, gk
gm      = and 24, gl
        st.l gm, R_SIDE(r6)
        // the normal in eye coordinates
        for i 0 1 2
mx$i    = fld.l 32*$i+NORMAL(r29)
my$i    = fld.l 32*$i+NORMAL+4(r29)
mz$i    = fld.l 32*$i+NORMAL+8(r29)
        endfor
        for k 0 1 2
e0$k    = fld.l P_EYE+16*$k(r20)
e1$k    = fld.l P_EYE+16*$k+4(r20)
@last e2$k    = fld.l P_EYE+16*$k+8(r20)
        for i 0 1 2
ha$k$i  = mul.ss e0$k, mx$i
        endfor
        for i 0 1 2
hb$k$i  = mul.ss e1$k, my$i
        endfor
        for i 0 1 2
hc$k$i  = mul.ss e2$k, mz$i
        endfor
        for i 0 1 2
hd$k$i  = add.ss ha$k$i, hb$k$i
        endfor
        for i 0 1 2
he$k$i  = add.ss hd$k$i, hc$k$i
hf$k$i  = add.ss he$k$i, round
        fst.l hf$k$i, RECORD*$i+R_SURFACE+4*$k(r6)
        endfor
        endfor
colour  = ld.l COLOUR(r29)
        st.l colour, R_COLOUR(r6)
        prefetch TRIANGLE_BYTES+64(r29) !last
