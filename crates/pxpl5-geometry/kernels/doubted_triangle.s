doubted = ld.l R_DOUBT(r3)
