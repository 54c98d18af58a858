        // from corner 0 to the pixel of reference, and that itself, as doubles
sixteenth = fld.l P_SIXTEENTH_S(r20)
rounds  = fld.l P_ROUND_S(r20)
rxb     = adds rx, bias
rxc     = ixfr rxb
rxs     = sub.ss rxc, rounds
rxd     = sub.sd rxc, rounds
@rx     fst.d rxd, FROM_X(r2)
txa     = mul.ss qx0, sixteenth
tx      = add.sd rxs, txa
@tx     fst.d tx, TO_X(r2)
ryb     = adds ry, bias
ryc     = ixfr ryb
rys     = sub.ss ryc, rounds
ryd     = sub.sd ryc, rounds
@ry     fst.d ryd, FROM_Y(r2)
tya     = mul.ss qy0, sixteenth
ty      = add.sd rys, tya
@ty     fst.d ty, TO_Y(r2)
