        // depth and the three words of the surface, two planes beside each other: slopes, and the value at the origin from that at the
        // pixel of reference
ta      = and 8, turned
tb      = adds ta, r20
sixteen = fld.d P_SIXTEENS(tb)
pp      = mul.dd ri, sixteen
sl      = fld.d P_SIDES(side)
pn      = mul.dd pp, sl
zqx    = fld.d S_z+0(r2) !zx
n0qx    = fld.d S_n0+0(r2) !n0x
zsx    = mul.dd zqx, pp
n0sx    = mul.dd n0qx, pn
zqy    = fld.d S_z+8(r2) !zy
n0qy    = fld.d S_n0+8(r2) !n0y
zsy    = mul.dd zqy, pp
n0sy    = mul.dd n0qy, pn
rr0    = fld.d P_ROUND(r20)
tx0    = fld.d TO_X(r2) !tx
        for p z n0
$pra    = add.dd $psx, rr0
        endfor
        for p z n0
$pta    = mul.dd $psx, tx0
        endfor
ty0    = fld.d TO_Y(r2) !ty
        for p z n0
$prb    = add.dd $psy, rr0
        endfor
        for p z n0
$ptb    = mul.dd $psy, ty0
        endfor
        for p z n0
$pua    = sub.dd $pra, rr0
        fst.l $pra, AT_$p(r18)
        endfor
        for p z n0
$pqv    = fld.d S_$p+16(r2) !$pv
$ptc    = add.dd $pqv, $pta
        endfor
        for p z n0
$pub    = sub.dd $prb, rr0
$prc    = add.dd $prb, $pub
        fst.l $prc, AT_$p+4(r18)
        endfor
rx0    = fld.d FROM_X(r2) !rx
        for p z n0
$pba    = mul.dd $pua, rx0
        endfor
        for p z n0
$ptd    = add.dd $ptc, $ptb
        endfor
ry0    = fld.d FROM_Y(r2) !ry
        for p z n0
$pbb    = mul.dd $pub, ry0
        endfor
        for p z n0
$pte    = add.dd $ptd, rr0
        endfor
        for p z n0
$pbc    = add.dd $pba, $pbb
        endfor
        for p z n0
$pc     = sub.dd $pte, $pbc
        fst.l $pc, AT_$p+8(r18)
        endfor
n1qx    = fld.d S_n1+0(r2) !n1x
n2qx    = fld.d S_n2+0(r2) !n2x
n1sx    = mul.dd n1qx, pn
n2sx    = mul.dd n2qx, pn
n1qy    = fld.d S_n1+8(r2) !n1y
n2qy    = fld.d S_n2+8(r2) !n2y
n1sy    = mul.dd n1qy, pn
n2sy    = mul.dd n2qy, pn
rr1    = fld.d P_ROUND(r20)
tx1    = fld.d TO_X(r2) !tx
        for p n1 n2
$pra    = add.dd $psx, rr1
        endfor
        for p n1 n2
$pta    = mul.dd $psx, tx1
        endfor
ty1    = fld.d TO_Y(r2) !ty
        for p n1 n2
$prb    = add.dd $psy, rr1
        endfor
        for p n1 n2
$ptb    = mul.dd $psy, ty1
        endfor
        for p n1 n2
$pua    = sub.dd $pra, rr1
        fst.l $pra, AT_$p(r18)
        endfor
        for p n1 n2
$pqv    = fld.d S_$p+16(r2) !$pv
$ptc    = add.dd $pqv, $pta
        endfor
        for p n1 n2
$pub    = sub.dd $prb, rr1
$prc    = add.dd $prb, $pub
        fst.l $prc, AT_$p+4(r18)
        endfor
rx1    = fld.d FROM_X(r2) !rx
        for p n1 n2
$pba    = mul.dd $pua, rx1
        endfor
        for p n1 n2
$ptd    = add.dd $ptc, $ptb
        endfor
ry1    = fld.d FROM_Y(r2) !ry
        for p n1 n2
$pbb    = mul.dd $pub, ry1
        endfor
        for p n1 n2
$pte    = add.dd $ptd, rr1
        endfor
        for p n1 n2
$pbc    = add.dd $pba, $pbb
        endfor
        for p n1 n2
$pc     = sub.dd $pte, $pbc
        fst.l $pc, AT_$p+8(r18)
        endfor
