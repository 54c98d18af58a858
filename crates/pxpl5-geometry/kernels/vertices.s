// Dual-instruction code: the positions of three corners.

// Settings of the scheduler that gave the shortest code: window, eagerness, reserve, slope and shake.
.if GOURAUD & STRIPS
        .linear 300 30 2 3 0
.elseif GOURAUD
        .linear 300 20 2 3 0
.elseif PHONG & STRIPS
        .linear 100 30 1 8 0
.else
        .linear 100 30 1 5 0
.endif
        for c 0 1 2
o$c      = fld.l P_ORIGIN+4*$c(r20)
        endfor
        for i 0 1 2
px$i     = fld.l 32*$i(r29)
x$i      = sub.ss px$i, o0
        endfor
        for i 0 1 2
py$i     = fld.l 32*$i+4(r29)
y$i      = sub.ss py$i, o1
        endfor
        for i 0 1 2
pz$i     = fld.l 32*$i+8(r29)
z$i      = sub.ss pz$i, o2
        endfor
cw0     = fld.l P_ROWS+48(r20)
cw1     = fld.l P_ROWS+52(r20)
        for i 0 1 2
cwa$i    = mul.ss cw0, x$i
        endfor
        for i 0 1 2
cwb$i    = mul.ss cw1, y$i
        endfor
cw2     = fld.l P_ROWS+56(r20)
        for i 0 1 2
cwd$i    = add.ss cwa$i, cwb$i
        endfor
        for i 0 1 2
cwc$i    = mul.ss cw2, z$i
        endfor
cw3     = fld.l P_ROWS+60(r20)
        for i 0 1 2
cwe$i    = add.ss cwd$i, cwc$i
        endfor
        for i 0 1 2
w$i     = add.ss cwe$i, cw3
        endfor
        prefetch TRIANGLE_BYTES(r29)
two     = fld.l P_TWO_S(r20)
        for i 0 1 2
s$i     = rcp.ss w$i
        endfor
        for i 0 1 2
na$i    = mul.ss w$i, s$i
        endfor
        for i 0 1 2
nb$i    = sub.ss two, na$i
        endfor
cz0     = fld.l P_ROWS+32(r20)
cz1     = fld.l P_ROWS+36(r20)
        for i 0 1 2
cza$i    = mul.ss cz0, x$i
        endfor
        for i 0 1 2
czb$i    = mul.ss cz1, y$i
        endfor
cz2     = fld.l P_ROWS+40(r20)
        for i 0 1 2
czd$i    = add.ss cza$i, czb$i
        endfor
        for i 0 1 2
czc$i    = mul.ss cz2, z$i
        endfor
cz3     = fld.l P_ROWS+44(r20)
        for i 0 1 2
cze$i    = add.ss czd$i, czc$i
        endfor
        for i 0 1 2
zz$i     = add.ss cze$i, cz3
        endfor
        for i 0 1 2
nc$i    = mul.ss s$i, nb$i
        endfor
        for i 0 1 2
nd$i    = mul.ss w$i, nc$i
        endfor
        for i 0 1 2
ne$i    = sub.ss two, nd$i
        endfor
        // The depth must differ from w so much that rounding does not matter, and w must be a valid divisor.
        prefetch TRIANGLE_BYTES+32(r29)
least   = ld.l P_LEAST_W(r20)
most    = ld.l P_MOST_W(r20)
nearly  = ld.l P_NEARLY(r20)
        for i 0 1 2
d$i     = sub.ss w$i, zz$i
@w$i    fst.l w$i, SCRATCH+16*$i(r2)
@z$i    fst.l zz$i, SCRATCH+16*$i+4(r2)
@d$i    fst.l d$i, SCRATCH+16*$i+8(r2)
        endfor
cx0     = fld.l P_ROWS+0(r20)
cx1     = fld.l P_ROWS+4(r20)
        for i 0 1 2
cxa$i    = mul.ss cx0, x$i
        endfor
        for i 0 1 2
cxb$i    = mul.ss cx1, y$i
        endfor
cx2     = fld.l P_ROWS+8(r20)
        for i 0 1 2
cxd$i    = add.ss cxa$i, cxb$i
        endfor
        for i 0 1 2
cxc$i    = mul.ss cx2, z$i
        endfor
cx3     = fld.l P_ROWS+12(r20)
        for i 0 1 2
cxe$i    = add.ss cxd$i, cxc$i
        endfor
        for i 0 1 2
xx$i     = add.ss cxe$i, cx3
        endfor
        for i 0 1 2
v$i     = mul.ss nc$i, ne$i
        endfor
cy0     = fld.l P_ROWS+16(r20)
cy1     = fld.l P_ROWS+20(r20)
        for i 0 1 2
cya$i    = mul.ss cy0, x$i
        endfor
        for i 0 1 2
cyb$i    = mul.ss cy1, y$i
        endfor
cy2     = fld.l P_ROWS+24(r20)
        for i 0 1 2
cyd$i    = add.ss cya$i, cyb$i
        endfor
        for i 0 1 2
cyc$i    = mul.ss cy2, z$i
        endfor
cy3     = fld.l P_ROWS+28(r20)
        for i 0 1 2
cye$i    = add.ss cyd$i, cyc$i
        endfor
        for i 0 1 2
yy$i     = add.ss cye$i, cy3
        endfor
.if !PRECOMPUTED
        for i 0 1 2
nx$i     = fld.l 32*$i+NORMAL(r29)
ga$i    = mul.ss x$i, nx$i
        endfor
        for i 0 1 2
ny$i     = fld.l 32*$i+NORMAL+4(r29)
gb$i    = mul.ss y$i, ny$i
        endfor
        for i 0 1 2
nz$i     = fld.l 32*$i+NORMAL+8(r29)
gc$i    = mul.ss z$i, nz$i
gd$i    = add.ss ga$i, gb$i
        endfor
        for i 0 1 2
ge$i    = add.ss gd$i, gc$i
        endfor
.endif
        for i 0 1 2
@iw$i   iw$i    = ld.l SCRATCH+16*$i(r2) !w$i
iz$i    = ld.l SCRATCH+16*$i+4(r2) !z$i
@e$i    id$i    = ld.l SCRATCH+16*$i+8(r2) !d$i
fa$i    = subs iw$i, least
fb$i    = subs most, iw$i
fc$i    = subs id$i, iw$i
fd$i    = adds fc$i, nearly
fe$i    = or fa$i, fb$i
ff$i    = or iz$i, id$i
fg$i    = or fe$i, ff$i
fh$i    = or fg$i, fd$i
@fh$i   st.l fh$i, SCRATCH+16*$i(r2) !iw$i
        endfor
scalex  = fld.l P_SCREEN(r20)
middlex = fld.l P_SCREEN+8(r20)
round   = fld.l P_ROUND_S(r20)
turn    = fld.l P_TURN(r20)
        for i 0 1 2
xf$i    = mul.ss xx$i, v$i
        endfor
        for i 0 1 2
xg$i    = mul.ss xf$i, scalex
        endfor
        for i 0 1 2
xi$i    = add.ss xg$i, middlex
xj$i    = sub.ss turn, xi$i
@xi$i   fst.l xi$i, RECORD*$i+R_SNAPPED(r6)
@xj$i   fst.l xj$i, RECORD*$i+R_TURNED(r6)
        endfor
scaley  = fld.l P_SCREEN+4(r20)
middley = fld.l P_SCREEN+12(r20)
        for i 0 1 2
yf$i    = mul.ss yy$i, v$i
        endfor
        for i 0 1 2
yg$i    = mul.ss yf$i, scaley
        endfor
        for i 0 1 2
yi$i    = add.ss yg$i, middley
yj$i    = sub.ss turn, yi$i
@yi$i   fst.l yi$i, RECORD*$i+R_SNAPPED+4(r6)
@yj$i   fst.l yj$i, RECORD*$i+R_TURNED+4(r6)
        endfor
range   = fld.l P_DEPTH_SCALE(r20)
biased  = fld.d P_DEPTH_BIAS(r20)
        for i 0 1 2
zr$i    = fld.l SCRATCH+16*$i+4(r2) !z$i
zf$i    = mul.ss v$i, range
zg$i    = mul.sd zr$i, zf$i
zh$i    = add.dd zg$i, biased
        fst.d zh$i, RECORD*$i+R_DEPTH(r6)
        endfor
