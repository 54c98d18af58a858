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
