round   = fld.l P_ROUND_S(r20)
        // edges: a and b in integers
xa      = ld.l R_SNAPPED(r3)
ya      = ld.l R_SNAPPED+4(r3)
xb      = ld.l R_SNAPPED(second)
yb      = ld.l R_SNAPPED+4(second)
xc      = ld.l R_SNAPPED(third)
yc      = ld.l R_SNAPPED+4(third)
ea0     = subs ya, yb
eb0     = subs xb, xa
ea1     = subs yb, yc
eb1     = subs xc, xb
ea2     = subs yc, ya
eb2     = subs xa, xc
roundy  = fld.l P_ROUND_LINE(r20)
round56     = fld.d P_ROUND56(r20)
nnb     = fld.d R_TURNED(second)
nnc     = fld.d R_TURNED(third)
qx0     = sub.ss na.0, round
qy0     = sub.ss na.1, roundy
qx1     = sub.ss nnb.0, round
qy1     = sub.ss nnb.1, roundy
qx2     = sub.ss nnc.0, round
qy2     = sub.ss nnc.1, roundy
        for k 0 1 2
        // 2 a + (b > 0) is positive for a top and for a left edge, which own their pixels
ta$k    = subs r0, eb$k
tb$k    = shra 31, ta$k
tc$k    = subs tb$k, ea$k
te$k    = subs tc$k, ea$k
tf$k    = shra 31, te$k
tg$k    = shl 3, tf$k
th$k    = adds tg$k, r20
tie$k   = fld.d P_TIE_OUT(th$k)
ka$k    = mul.sd ex$k, qy$k
kb$k    = mul.sd ey$k, qx$k
kc$k    = sub.dd ka$k, kb$k
kd$k    = add.dd kc$k, tie$k
ke$k    = add.dd kd$k, round56
        fst.l ke$k, 16*$k+16(r18)
        st.l ea$k, 16*$k+8(r18)
        endfor
