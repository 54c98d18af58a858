// Dual-instruction code: the surface values of three corners.

.if PRECOMPUTED
        // The precomputed colours at the corners.
above   = orh 0x4B40, r0
        for i 0 1 2
ka$i    = ld.l 32*$i+COLOUR(r29)
kb$i    = shr 8, ka$i
kc$i    = shl 8, ka$i
la0$i   = and 0xFF00, kb$i
la1$i   = and 0xFF00, ka$i
la2$i   = and 0xFF00, kc$i
        for k 0 1 2
lb$k$i  = or above, la$k$i
        st.l lb$k$i, RECORD*$i+R_SURFACE+4*$k(r6)
        endfor
        endfor
        prefetch TRIANGLE_BYTES+64(r29)
.elseif GOURAUD
        // The light at the corners: the cosine (for the other side if the normal turns away), at least 0; then 0 to 1
        // of the colour.
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
.if !STRIPS
        st.l r0, R_SIDE(r6)
.endif
.else
.if !STRIPS
        // Do the normals together turn away? The result is the position in the table of sides.
gf      = add.ss ge0, ge1
gg      = add.ss gf, ge2
@gg     fst.l gg, SIDE_WORD(r2)
gh      = ld.l SIDE_WORD(r2) !gg
gi      = shra 31, gh
gj      = subs r0, gh
gk      = shra 31, gj
gl      = andnot gi, gk
gm      = and 24, gl
        st.l gm, R_SIDE(r6)
.endif
        // The normal in eye coordinates.
        for i 0 1 2
mx$i    = fld.l 32*$i+NORMAL(r29)
my$i    = fld.l 32*$i+NORMAL+4(r29)
mz$i    = fld.l 32*$i+NORMAL+8(r29)
        endfor
        for k 0 1 2
e0$k    = fld.l P_EYE+16*$k(r20)
e1$k    = fld.l P_EYE+16*$k+4(r20)
@last e2$k    = fld.l P_EYE+16*$k+8(r20)
        for i 0 1 2
ha$k$i  = mul.ss e0$k, mx$i
        endfor
        for i 0 1 2
hb$k$i  = mul.ss e1$k, my$i
        endfor
        for i 0 1 2
hc$k$i  = mul.ss e2$k, mz$i
        endfor
        for i 0 1 2
hd$k$i  = add.ss ha$k$i, hb$k$i
        endfor
        for i 0 1 2
he$k$i  = add.ss hd$k$i, hc$k$i
hf$k$i  = add.ss he$k$i, round
        fst.l hf$k$i, RECORD*$i+R_SURFACE+4*$k(r6)
        endfor
        endfor
.if STRIPS
        // Separately for each corner, because triangles of a strip share corners.
        for i 0 1 2
        fst.l ge$i, RECORD*$i+R_SIDE(r6)
colour$i = ld.l 32*$i+COLOUR(r29)
        st.l colour$i, RECORD*$i+R_COLOUR(r6)
        endfor
        prefetch TRIANGLE_BYTES+64(r29) !last
.else
colour  = ld.l COLOUR(r29)
        st.l colour, R_COLOUR(r6)
        prefetch TRIANGLE_BYTES+64(r29) !last
.endif
.endif
