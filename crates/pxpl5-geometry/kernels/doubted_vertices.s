        // in doubt where one of the corners is
doubt0  = ld.l R_DOUBT(r3)
doubt1  = ld.l R_DOUBT(r4)
doubt2  = ld.l R_DOUBT(r5)
doubt01 = or doubt0, doubt1
doubted = or doubt01, doubt2
