        // on the whole turned away? the place in the table of sides
away0   = fld.l R_SIDE(r3)
away1   = fld.l R_SIDE(r4)
away2   = fld.l R_SIDE(r5)
away01  = add.ss away0, away1
away    = add.ss away01, away2
@away   fst.l away, SIDE_WORD(r2)
awayw      = ld.l SIDE_WORD(r2) !away
away_a     = shra 31, awayw
away_b     = subs r0, awayw
away_c     = shra 31, away_b
away_d     = andnot away_a, away_c
turn    = and 24, away_d
side    = adds turn, r20
