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
