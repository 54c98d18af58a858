turn    = ld.l R_SIDE(r3)
side    = adds turn, r20
