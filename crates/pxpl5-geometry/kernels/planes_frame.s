        // from corner 0 to its centre, and itself, as doubles
nax     = ld.l R_TURNED(r3)
nay     = ld.l R_TURNED+4(r3)
less    = orh 0xFE00, r0
round19 = fld.l P_ROUND19(r20)
txa     = shl 4, rx
txb     = adds txa, nax
txc     = adds txb, less
txd     = ixfr txc
tx      = sub.sd txd, round19
@tx     fst.d tx, TO_X(r2)
tya     = shl 4, ry
tyb     = adds tya, nay
tyc     = adds tyb, less
tyd     = ixfr tyc
ty      = sub.sd tyd, round19
@ty     fst.d ty, TO_Y(r2)
rounds  = fld.l P_ROUND_S(r20)
rxb     = adds rx, bias
rxc     = ixfr rxb
rxd     = sub.sd rxc, rounds
@rx     fst.d rxd, FROM_X(r2)
ryb     = adds ry, bias
ryc     = ixfr ryb
ryd     = sub.sd ryc, rounds
@ry     fst.d ryd, FROM_Y(r2)
        for k 0 1 2
        st.l eb$k, 16*$k+12(r18)
        endfor
ta      = and 8, turned
tb      = adds ta, r20
sixteen = fld.d P_SIXTEENS(tb)
pp      = mul.dd ri, sixteen
sl      = fld.d P_SIDES(side)
pn      = mul.dd pp, sl
        // depth and the three words of the surface, two planes beside each other
zqx     = fld.d SLOPES+0(r2) !zx
n0qx     = fld.d SLOPES+24(r2) !nx0
zsx     = mul.dd zqx, pp
n0sx     = mul.dd n0qx, pn
zqy     = fld.d SLOPES+0+8(r2) !zy
n0qy     = fld.d SLOPES+24+8(r2) !ny0
zsy     = mul.dd zqy, pp
n0sy     = mul.dd n0qy, pn
rr0     = fld.d P_ROUND(r20)
tx0     = fld.d TO_X(r2) !tx
zra     = add.dd zsx, rr0
n0ra     = add.dd n0sx, rr0
zta     = mul.dd zsx, tx0
n0ta     = mul.dd n0sx, tx0
ty0     = fld.d TO_Y(r2) !ty
zrb     = add.dd zsy, rr0
n0rb     = add.dd n0sy, rr0
ztb     = mul.dd zsy, ty0
n0tb     = mul.dd n0sy, ty0
zua     = sub.dd zra, rr0
        fst.l zra, 56(r18)
n0ua     = sub.dd n0ra, rr0
        fst.l n0ra, 76(r18)
zqv     = fld.d SLOPES+0+16(r2) !zv
ztc     = add.dd zqv, zta
n0qv     = fld.d SLOPES+24+16(r2) !nv0
n0tc     = add.dd n0qv, n0ta
zub     = sub.dd zrb, rr0
        fst.l zrb, 56+4(r18)
n0ub     = sub.dd n0rb, rr0
        fst.l n0rb, 76+4(r18)
rx0     = fld.d FROM_X(r2) !rx
zba     = mul.dd zua, rx0
n0ba     = mul.dd n0ua, rx0
ztd     = add.dd ztc, ztb
n0td     = add.dd n0tc, n0tb
ry0     = fld.d FROM_Y(r2) !ry
zbb     = mul.dd zub, ry0
n0bb     = mul.dd n0ub, ry0
zte     = add.dd ztd, rr0
n0te     = add.dd n0td, rr0
zbc     = add.dd zba, zbb
n0bc     = add.dd n0ba, n0bb
zc      = sub.dd zte, zbc
        fst.l zc, 56+8(r18)
n0c      = sub.dd n0te, n0bc
        fst.l n0c, 76+8(r18)
n1qx     = fld.d SLOPES+48(r2) !nx1
n2qx     = fld.d SLOPES+72(r2) !nx2
n1sx     = mul.dd n1qx, pn
n2sx     = mul.dd n2qx, pn
n1qy     = fld.d SLOPES+48+8(r2) !ny1
n2qy     = fld.d SLOPES+72+8(r2) !ny2
n1sy     = mul.dd n1qy, pn
n2sy     = mul.dd n2qy, pn
rr1     = fld.d P_ROUND(r20)
tx1     = fld.d TO_X(r2) !tx
n1ra     = add.dd n1sx, rr1
n2ra     = add.dd n2sx, rr1
n1ta     = mul.dd n1sx, tx1
n2ta     = mul.dd n2sx, tx1
ty1     = fld.d TO_Y(r2) !ty
n1rb     = add.dd n1sy, rr1
n2rb     = add.dd n2sy, rr1
n1tb     = mul.dd n1sy, ty1
n2tb     = mul.dd n2sy, ty1
n1ua     = sub.dd n1ra, rr1
        fst.l n1ra, 92(r18)
n2ua     = sub.dd n2ra, rr1
        fst.l n2ra, 108(r18)
n1qv     = fld.d SLOPES+48+16(r2) !nv1
n1tc     = add.dd n1qv, n1ta
n2qv     = fld.d SLOPES+72+16(r2) !nv2
n2tc     = add.dd n2qv, n2ta
n1ub     = sub.dd n1rb, rr1
        fst.l n1rb, 92+4(r18)
n2ub     = sub.dd n2rb, rr1
        fst.l n2rb, 108+4(r18)
rx1     = fld.d FROM_X(r2) !rx
n1ba     = mul.dd n1ua, rx1
n2ba     = mul.dd n2ua, rx1
n1td     = add.dd n1tc, n1tb
n2td     = add.dd n2tc, n2tb
ry1     = fld.d FROM_Y(r2) !ry
n1bb     = mul.dd n1ub, ry1
n2bb     = mul.dd n2ub, ry1
n1te     = add.dd n1td, rr1
n2te     = add.dd n2td, rr1
n1bc     = add.dd n1ba, n1bb
n2bc     = add.dd n2ba, n2bb
n1c      = sub.dd n1te, n1bc
        fst.l n1c, 92+8(r18)
n2c      = sub.dd n2te, n2bc
        fst.l n2c, 108+8(r18)
