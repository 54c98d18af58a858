        // slopes before they are divided by the area, and values at corner 0
depth0  = fld.d R_DEPTH(r3)
depth1  = fld.d R_DEPTH(second)
depth2  = fld.d R_DEPTH(third)
zr0     = fld.d P_ROUND(r20)
zd1     = sub.dd depth0, depth1
zd2     = sub.dd depth2, depth0
zv0     = sub.dd depth0, zr0
@zv     fst.d zv0, S_z+16(r2)
ey2d    = mov.sd ey2
ey0d    = mov.sd ey0
sxa     = mul.dd zd1, ey2d
sxb     = mul.dd zd2, ey0d
ex0d    = mov.sd ex0
ex2d    = mov.sd ex2
sya     = mul.dd zd2, ex0d
syb     = mul.dd zd1, ex2d
sxc     = sub.dd sxa, sxb
syc     = sub.dd sya, syb
@zx     fst.d sxc, S_z(r2)
@zy     fst.d syc, S_z+8(r2)
sm      = fld.l P_SIDES+8(side)
sn      = fld.d P_SIDES+16(side)
        for k 0 1 2
n0$k    = fld.l R_SURFACE+4*$k(r3)
n1$k    = fld.l R_SURFACE+4*$k(second)
n2$k    = fld.l R_SURFACE+4*$k(third)
da$k    = sub.ss n0$k, n1$k
db$k    = sub.ss n2$k, n0$k
me$k    = mul.sd n0$k, sm
mh$k    = add.dd me$k, sn
@n$kv   fst.d mh$k, S_n$k+16(r2)
        endfor
        for k 0 1 2
ma$k    = mul.sd da$k, ey2
mb$k    = mul.sd db$k, ey0
mf$k    = sub.dd ma$k, mb$k
mc$k    = mul.sd db$k, ex0
md$k    = mul.sd da$k, ex2
mg$k    = sub.dd mc$k, md$k
@n$kx   fst.d mf$k, S_n$k(r2)
@n$ky   fst.d mg$k, S_n$k+8(r2)
        endfor
