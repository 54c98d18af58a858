        // and not so far beside the picture that the words have lost their order
        for i 0 1 2
qa$i    = ld.l RECORD*$i+R_SNAPPED(r6) !xi$i
qb$i    = ld.l RECORD*$i+R_TURNED(r6) !xj$i
qc$i    = or qa$i, qb$i
qd$i    = ld.l RECORD*$i+R_SNAPPED+4(r6) !yi$i
qe$i    = ld.l RECORD*$i+R_TURNED+4(r6) !yj$i
qf$i    = or qd$i, qe$i
qg$i    = or qc$i, qf$i
qh$i    = ld.l SCRATCH+16*$i(r2) !fh$i
qi$i    = or qg$i, qh$i
        endfor
