        // edges: a = -dy and b = dx in integers by way of 1.5 * 2^52
round52 = fld.l P_ROUND52_S(r20)
two18   = fld.l P_TWO18(r20)
round   = fld.l P_ROUND_S(r20)
roundy  = fld.l P_ROUND_LINE(r20)
round56 = fld.d P_ROUND56(r20)
nnb     = fld.d R_TURNED(second)
nnc     = fld.d R_TURNED(third)
qx0     = sub.ss na.0, round
qy0     = sub.ss na.1, roundy
qx1     = sub.ss nnb.0, round
qy1     = sub.ss nnb.1, roundy
qx2     = sub.ss nnc.0, round
qy2     = sub.ss nnc.1, roundy
        for k 0 1 2
        // dy 2^18 - dx is negative for a top and for a left edge, which own their pixels
ta$k    = mul.ss ey$k, two18
tb$k    = sub.ss ta$k, ex$k
@tie$k  fst.l tb$k, TIES+4*$k(r2)
ka$k    = mul.sd ex$k, qy$k
kb$k    = mul.sd ey$k, qx$k
kc$k    = sub.dd ka$k, kb$k
wa$k    = sub.sd round52, ey$k
        fst.l wa$k, 16*$k+8(r18)
tc$k    = ld.l TIES+4*$k(r2) !tie$k
td$k    = shra 28, tc$k
te$k    = andnot 7, td$k
th$k    = adds te$k, r20
tie$k   = fld.d P_TIE_OUT(th$k)
kd$k    = add.dd kc$k, tie$k
ke$k    = add.dd kd$k, round56
        fst.l ke$k, 16*$k+16(r18)
        endfor
