        // the light at the corners: the cosine, of the other side where the normal turns away, at least 0; 0 to 1 of the colour
        for c 0 1 2
l$c      = fld.l P_LIGHT+4*$c(r20)
        endfor
amb     = fld.l P_AMBIENT(r20)
dif     = fld.l P_DIFFUSE(r20)
one     = ld.l P_ONE(r20)
        for i 0 1 2
mx$i    = fld.l 32*$i+NORMAL(r29)
my$i    = fld.l 32*$i+NORMAL+4(r29)
mz$i    = fld.l 32*$i+NORMAL+8(r29)
ha$i    = mul.ss l0, mx$i
hb$i    = mul.ss l1, my$i
hc$i    = mul.ss l2, mz$i
hd$i    = add.ss ha$i, hb$i
he$i    = add.ss hd$i, hc$i
@h$i    fst.l he$i, SCRATCH+16*$i+12(r2)
        endfor
        for i 0 1 2
@g$i    fst.l ge$i, SCRATCH+16*$i+8(r2) !e$i
ia$i    = ld.l SCRATCH+16*$i+8(r2) !g$i
ib$i    = ld.l SCRATCH+16*$i+12(r2) !h$i
ic$i    = shra 31, ia$i
ie$i    = subs r0, ia$i
if$i    = shra 31, ie$i
ig$i    = andnot ic$i, if$i
ih$i    = shl 31, ig$i
ii$i    = xor ib$i, ih$i
ij$i    = shra 31, ii$i
ik$i    = andnot ij$i, ii$i
il$i    = ixfr ik$i
im$i    = mul.ss dif, il$i
in$i    = add.ss amb, im$i
@n$i    fst.l in$i, SIDE_WORD+8*$i(r2)
        endfor
        for i 0 1 2
ja$i    = ld.l SIDE_WORD+8*$i(r2) !n$i
jb$i    = shra 31, ja$i
jc$i    = andnot jb$i, ja$i
jd$i    = subs one, jc$i
je$i    = shra 31, jd$i
jf$i    = and je$i, jd$i
jg$i    = adds jf$i, jc$i
jh$i    = ixfr jg$i
        endfor
two23   = fld.l P_TWO23(r20)
above   = orh 0x4B00, r0
        for i 0 1 2
ka$i    = ld.l 32*$i+COLOUR(r29)
kb$i    = shr 8, ka$i
kc$i    = shl 8, ka$i
la0$i   = and 0xFF00, kb$i
la1$i   = and 0xFF00, ka$i
la2$i   = and 0xFF00, kc$i
        for k 0 1 2
lb$k$i  = or above, la$k$i
lc$k$i  = ixfr lb$k$i
ld$k$i  = sub.ss lc$k$i, two23
le$k$i  = mul.ss ld$k$i, jh$i
lf$k$i  = add.ss le$k$i, round
        fst.l lf$k$i, RECORD*$i+R_SURFACE+4*$k(r6)
        endfor
        endfor
        prefetch TRIANGLE_BYTES+64(r29)
