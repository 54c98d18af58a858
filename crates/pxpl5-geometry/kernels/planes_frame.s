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
        // on the whole turned away?
fa      = fld.l R_AWAY(r3)
fb      = fld.l R_AWAY(r4)
fc      = fld.l R_AWAY(r5)
fd      = add.ss fa, fb
fe      = add.ss fd, fc
@side   fst.l fe, SIDE_WORD(r2)
ff      = ld.l SIDE_WORD(r2) !side
fg      = shra 31, ff
fh      = subs r0, ff
fi      = shra 31, fh
fj      = andnot fg, fi
fk      = and 24, fj
side    = adds fk, r20
sl      = fld.d P_SIDES(side)
pn      = mul.dd pp, sl
@pn     fst.d pn, PER_PIXEL(r2)
        // depth and the three words of the surface, two planes beside each other
n00     = fld.l R_SURFACE+0(r3)
n10     = fld.l R_SURFACE+0(second)
n20     = fld.l R_SURFACE+0(third)
da0     = sub.ss n00, n10
db0     = sub.ss n20, n00
ma0     = mul.sd da0, ey2
mb0     = mul.sd db0, ey0
mc0     = mul.sd db0, ex0
md0     = mul.sd da0, ex2
mf0     = sub.dd ma0, mb0
mg0     = sub.dd mc0, md0
sm0     = fld.l P_SIDES+8(side)
sn0     = fld.d P_SIDES+16(side)
me0     = mul.sd n00, sm0
pn0     = fld.d PER_PIXEL(r2) !pn
n0v0    = add.dd me0, sn0
n0sx    = mul.dd mf0, pn0
n0sy    = mul.dd mg0, pn0
ey2d    = mov.sd ey2
ey0d    = mov.sd ey0
depth0  = fld.d R_DEPTH(r3)
depth1  = fld.d R_DEPTH(second)
depth2  = fld.d R_DEPTH(third)
zd1     = sub.dd depth0, depth1
zd2     = sub.dd depth2, depth0
sxa     = mul.dd zd1, ey2d
sxb     = mul.dd zd2, ey0d
ex0d    = mov.sd ex0
ex2d    = mov.sd ex2
sya     = mul.dd zd2, ex0d
syb     = mul.dd zd1, ex2d
sxc     = sub.dd sxa, sxb
syc     = sub.dd sya, syb
zr0     = fld.d P_ROUND(r20)
zv0     = sub.dd depth0, zr0
zsx     = mul.dd sxc, pp
zsy     = mul.dd syc, pp
rr0     = fld.d P_ROUND(r20)
tx0     = fld.d TO_X(r2) !tx
n0ta     = mul.dd n0sx, tx0
zta     = mul.dd zsx, tx0
ty0     = fld.d TO_Y(r2) !ty
n0tb     = mul.dd n0sy, ty0
ztb     = mul.dd zsy, ty0
n0ra     = add.dd n0sx, rr0
zra     = add.dd zsx, rr0
n0rb     = add.dd n0sy, rr0
zrb     = add.dd zsy, rr0
n0tc     = add.dd n0v0, n0ta
ztc     = add.dd zv0, zta
n0ua     = sub.dd n0ra, rr0
        fst.l n0ra, 76(r18)
zua     = sub.dd zra, rr0
        fst.l zra, 56(r18)
n0ub     = sub.dd n0rb, rr0
        fst.l n0rb, 76+4(r18)
zub     = sub.dd zrb, rr0
        fst.l zrb, 56+4(r18)
rx0     = fld.d FROM_X(r2) !rx
n0td     = add.dd n0tc, n0tb
ztd     = add.dd ztc, ztb
n0ba     = mul.dd n0ua, rx0
zba     = mul.dd zua, rx0
ry0     = fld.d FROM_Y(r2) !ry
n0te     = add.dd n0td, rr0
zte     = add.dd ztd, rr0
n0bb     = mul.dd n0ub, ry0
zbb     = mul.dd zub, ry0
n0bc     = add.dd n0ba, n0bb
zbc     = add.dd zba, zbb
n0c      = sub.dd n0te, n0bc
        fst.l n0c, 76+8(r18)
zc      = sub.dd zte, zbc
        fst.l zc, 56+8(r18)
n01     = fld.l R_SURFACE+4(r3)
n11     = fld.l R_SURFACE+4(second)
n21     = fld.l R_SURFACE+4(third)
da1     = sub.ss n01, n11
db1     = sub.ss n21, n01
ma1     = mul.sd da1, ey2
mb1     = mul.sd db1, ey0
mc1     = mul.sd db1, ex0
md1     = mul.sd da1, ex2
mf1     = sub.dd ma1, mb1
mg1     = sub.dd mc1, md1
sm1     = fld.l P_SIDES+8(side)
sn1     = fld.d P_SIDES+16(side)
me1     = mul.sd n01, sm1
pn1     = fld.d PER_PIXEL(r2) !pn
n1v0    = add.dd me1, sn1
n1sx    = mul.dd mf1, pn1
n1sy    = mul.dd mg1, pn1
n02     = fld.l R_SURFACE+8(r3)
n12     = fld.l R_SURFACE+8(second)
n22     = fld.l R_SURFACE+8(third)
da2     = sub.ss n02, n12
db2     = sub.ss n22, n02
ma2     = mul.sd da2, ey2
mb2     = mul.sd db2, ey0
mc2     = mul.sd db2, ex0
md2     = mul.sd da2, ex2
mf2     = sub.dd ma2, mb2
mg2     = sub.dd mc2, md2
sm2     = fld.l P_SIDES+8(side)
sn2     = fld.d P_SIDES+16(side)
me2     = mul.sd n02, sm2
pn2     = fld.d PER_PIXEL(r2) !pn
n2v0    = add.dd me2, sn2
n2sx    = mul.dd mf2, pn2
n2sy    = mul.dd mg2, pn2
rr1     = fld.d P_ROUND(r20)
tx1     = fld.d TO_X(r2) !tx
n1ta     = mul.dd n1sx, tx1
n2ta     = mul.dd n2sx, tx1
ty1     = fld.d TO_Y(r2) !ty
n1tb     = mul.dd n1sy, ty1
n2tb     = mul.dd n2sy, ty1
n1ra     = add.dd n1sx, rr1
n2ra     = add.dd n2sx, rr1
n1rb     = add.dd n1sy, rr1
n2rb     = add.dd n2sy, rr1
n1tc     = add.dd n1v0, n1ta
n2tc     = add.dd n2v0, n2ta
n1ua     = sub.dd n1ra, rr1
        fst.l n1ra, 92(r18)
n2ua     = sub.dd n2ra, rr1
        fst.l n2ra, 108(r18)
n1ub     = sub.dd n1rb, rr1
        fst.l n1rb, 92+4(r18)
n2ub     = sub.dd n2rb, rr1
        fst.l n2rb, 108+4(r18)
rx1     = fld.d FROM_X(r2) !rx
n1td     = add.dd n1tc, n1tb
n2td     = add.dd n2tc, n2tb
n1ba     = mul.dd n1ua, rx1
n2ba     = mul.dd n2ua, rx1
ry1     = fld.d FROM_Y(r2) !ry
n1te     = add.dd n1td, rr1
n2te     = add.dd n2td, rr1
n1bb     = mul.dd n1ub, ry1
n2bb     = mul.dd n2ub, ry1
n1bc     = add.dd n1ba, n1bb
n2bc     = add.dd n2ba, n2bb
n1c      = sub.dd n1te, n1bc
        fst.l n1c, 92+8(r18)
n2c      = sub.dd n2te, n2bc
        fst.l n2c, 108+8(r18)
