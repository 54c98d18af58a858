// Dual-instruction code: the end of the loop over corners, and the loop over triangles.

        d.fnop
            adds    TRIANGLE_BYTES, r29, r29
        morecorners
        d.fnop
            adds    RECORDS, r2, r3
        d.fnop
            subs    r17, r31, r17
        d.fnop
            br      again
        d.fnop
            nop
        .align  32
again:  d.fnop
            ld.l    P_HEADS(r20), r24
        d.fnop
            ld.l    P_HEADS+4(r20), r25
        d.fnop
            adds    RECORD, r3, r4
        d.fnop
            adds    2*RECORD, r3, r5
triangles:
        passover
        doubtfulpairs
// Makes the words of a command at r18 from the triangle with the records at r3, r4 and r5.
AREA_WORD = 8
LOW_XY    = 16
HIGH_XY   = 24
SIDE_WORD = 32
ROW_WORD  = 56
TO_X      = 320
TO_Y      = 328
FROM_X    = 336
FROM_Y    = 344
TIES      = 352   // three words whose signs say which edges own their pixels
// For depth and each word of the surface: slopes before the division by the area, and the value at corner 0.
S_z       = 368
S_n0      = 392
S_n1      = 416
S_n2      = 440
// Positions of the planes in the command.
AT_z      = 56
AT_n0     = 76
AT_n1     = 92
AT_n2     = 108

        .pool   r1 r8 r9 r10 r11 r12 r13 r14 r15 r26 r27 r28 r29 r30 r6
// Settings of the scheduler that gave the shortest code: window, eagerness, reserve, slope and shake.
.if PHONG & FIELD & !BINNED & !CULLED
        .linear 300 20 2 8 0
.elseif !BINNED | CULLED
        .linear 64 15 2 8 0
.elseif PHONG & (STRIPS != FIELD)
        .linear 300 30 1 8 0
.elseif PHONG & FIELD
        .linear 150 20 2 8 0
.elseif PHONG
        .linear 150 20 1 8 0
.elseif !FIELD
        .linear 150 20 2 8 0
.elseif STRIPS
        .linear 64 20 1 8 0
.else
        .linear 64 15 2 8 0
.endif
.if STRIPS
        // A triangle is in doubt if one of its corners is in doubt.
doubt0  = ld.l R_DOUBT(r3)
doubt1  = ld.l R_DOUBT(r4)
doubt2  = ld.l R_DOUBT(r5)
doubt01 = or doubt0, doubt1
doubted = or doubt01, doubt2
.else
        // Triangles with corners in doubt do not reach this code.
doubted = or r0, r0
.endif
a       = fld.d R_SNAPPED(r3)
b       = fld.d R_SNAPPED(r4)
c       = fld.d R_SNAPPED(r5)
x1      = sub.ss b.0, a.0
y1      = sub.ss b.1, a.1
x2      = sub.ss c.0, a.0
y2      = sub.ss c.1, a.1
aa      = mul.sd x1, y2
ab      = mul.sd y1, x2
ac      = sub.dd aa, ab
@area   fst.d ac, AREA_WORD(r2)
seed    = rcp.dd ac
ad      = ld.l AREA_WORD+4(r2) !area
turned  = shra 31, ad
pa      = xor r4, r5
pb      = and pa, turned
second  = xor r4, pb
third   = xor r5, pb
ae      = shl 1, ad
af      = shr 1, ae
flat    = adds -1, af
        // The box: the least coordinates of the corners, and the least of the coordinates subtracted from 8.
na      = fld.d R_TURNED(r3)
nb      = fld.d R_TURNED(r4)
nc      = fld.d R_TURNED(r5)
la      = zmin.dd a, b
lb      = zmin.dd la, c
@low    fst.d lb, LOW_XY(r2)
ha      = zmin.dd na, nb
hb      = zmin.dd ha, nc
@high   fst.d hb, HIGH_XY(r2)
two     = fld.d P_TWO(r20)
ra      = mul.dd ac, seed
rb      = sub.dd two, ra
rc      = mul.dd seed, rb
.if CULLED
        // A triangle in the orientation that is not drawn is in doubt too.
cull_a  = ld.l P_CULL(r20)
cull_b  = xor cull_a, ad
cull_c  = ld.l P_CULL+4(r20)
culled  = and cull_c, cull_b
doubt_a = or doubted, flat
doubt   = or doubt_a, culled
.else
doubt   = or doubted, flat
.endif
bias    = orh 0x4B40, r0
bias8   = adds 8, bias
lxa     = ld.l LOW_XY(r2) !low
lya     = ld.l LOW_XY+4(r2) !low
hxa     = ld.l HIGH_XY(r2) !high
hya     = ld.l HIGH_XY+4(r2) !high
lx      = subs lxa, bias
ly      = subs lya, bias
hx      = subs bias8, hxa
hy      = subs bias8, hya
.if BINNED
        // The reference pixel: the middle of the visible part of the box. If no part is visible, there will be no
        // command.
lx_p    = shra 31, lx
lx_u    = andnot lx_p, lx
ly_p    = shra 31, ly
ly_u    = andnot ly_p, ly
.if GRID
lastx   = ld.l P_LAST_X(r20)
hx_r    = subs lastx, hx
.else
hx_r    = subs 10239, hx
.endif
hx_s    = shra 31, hx_r
hx_t    = and hx_s, hx_r
hx_u    = adds hx_t, hx
.if GRID
lasty   = ld.l P_LAST_Y(r20)
hy_r    = subs lasty, hy
.else
hy_r    = subs 7679, hy
.endif
hy_s    = shra 31, hy_r
hy_t    = and hy_s, hy_r
hy_u    = adds hy_t, hy
rxa     = adds lx_u, hx_u
rx      = shra 5, rxa
rya     = adds ly_u, hy_u
ry      = shra 5, rya
.else
        // The reference pixel: the middle of the part of the box in the picture, or the picture's nearest side.
        for v lx hx
$v_p     = shra 31, $v
$v_q     = andnot $v_p, $v
$v_r     = subs 10239, $v_q
$v_s     = shra 31, $v_r
$v_t     = and $v_s, $v_r
$v_u     = adds $v_t, $v_q
        endfor
        for v ly hy
$v_p     = shra 31, $v
$v_q     = andnot $v_p, $v
$v_r     = subs 7679, $v_q
$v_s     = shra 31, $v_r
$v_t     = and $v_s, $v_r
$v_u     = adds $v_t, $v_q
        endfor
rxa     = adds lx_u, hx_u
rx      = shra 5, rxa
rya     = adds ly_u, hy_u
ry      = shra 5, rya
.endif
        // Corners in clockwise order.
bb      = fld.d R_SNAPPED(second)
cc      = fld.d R_SNAPPED(third)
ex0     = sub.ss bb.0, a.0
ey0     = sub.ss bb.1, a.1
ex2     = sub.ss a.0, cc.0
ey2     = sub.ss a.1, cc.1
ex1     = sub.ss cc.0, bb.0
ey1     = sub.ss cc.1, bb.1
        // Continue the computation of 16 / area.
rd      = mul.dd ac, rc
re      = sub.dd two, rd
rf      = mul.dd rc, re
rg      = mul.dd ac, rf
rh      = sub.dd two, rg
ri      = mul.dd rf, rh
.if PHONG & STRIPS
        // Do the normals together turn away? The result is the position in the table of sides.
away0   = fld.l R_SIDE(r3)
away1   = fld.l R_SIDE(r4)
away2   = fld.l R_SIDE(r5)
away01  = add.ss away0, away1
away    = add.ss away01, away2
@away   fst.l away, SIDE_WORD(r2)
awayw      = ld.l SIDE_WORD(r2) !away
away_a     = shra 31, awayw
away_b     = subs r0, awayw
away_c     = shra 31, away_b
away_d     = andnot away_a, away_c
turn    = and 24, away_d
side    = adds turn, r20
.elseif PRECOMPUTED | STRIPS
side    = or r0, r20
.else
turn    = ld.l R_SIDE(r3)
side    = adds turn, r20
.endif
        // Slopes before the division by the area, and values at corner 0.
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
        // Edges: a = -dy and b = dx as integers, by an addition to 1.5 * 2^52.
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
        // dy 2^18 - dx is negative for a top edge and for a left edge. These edges own their pixels.
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
.if FIELD & !BINNED
        // Two lines of the frame are one line of the field.
        for k 0 1 2
wd$k    = add.ss ex$k, ex$k
wb$k    = add.sd round52, wd$k
        fst.l wb$k, 16*$k+12(r18)
        endfor
        // The distance from corner 0 to the reference pixel, and the reference pixel, as doubles.
sixteenth = fld.l P_SIXTEENTH_S(r20)
rounds  = fld.l P_ROUND_S(r20)
rxb     = adds rx, bias
rxc     = ixfr rxb
rxs     = sub.ss rxc, rounds
rxd     = sub.sd rxc, rounds
@rx     fst.d rxd, FROM_X(r2)
txa     = mul.ss qx0, sixteenth
tx      = add.sd rxs, txa
@tx     fst.d tx, TO_X(r2)
line    = ld.l P_LINE(r20)
ryl     = subs ry, line
ryb     = adds ryl, bias
ryc     = ixfr ryb
rys     = sub.ss ryc, rounds
ryd     = sub.sd ryc, rounds
@ry     fst.d ryd, FROM_Y(r2)
tya     = mul.ss qy0, sixteenth
ty      = add.sd rys, tya
@ty     fst.d ty, TO_Y(r2)
.else
        for k 0 1 2
wb$k    = add.sd round52, ex$k
        fst.l wb$k, 16*$k+12(r18)
        endfor
        // The distance from corner 0 to the reference pixel, and the reference pixel, as doubles.
sixteenth = fld.l P_SIXTEENTH_S(r20)
rounds  = fld.l P_ROUND_S(r20)
rxb     = adds rx, bias
rxc     = ixfr rxb
rxs     = sub.ss rxc, rounds
rxd     = sub.sd rxc, rounds
@rx     fst.d rxd, FROM_X(r2)
txa     = mul.ss qx0, sixteenth
tx      = add.sd rxs, txa
@tx     fst.d tx, TO_X(r2)
ryb     = adds ry, bias
ryc     = ixfr ryb
rys     = sub.ss ryc, rounds
ryd     = sub.sd ryc, rounds
@ry     fst.d ryd, FROM_Y(r2)
tya     = mul.ss qy0, sixteenth
ty      = add.sd rys, tya
@ty     fst.d ty, TO_Y(r2)
.endif
        // Depth and the three words of the surface, two planes at a time: slopes, and the value at the origin from the
        // value at the reference pixel.
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
.if FIELD & !BINNED
$prc    = add.dd $prb, $pub
        fst.l $prc, AT_$p+4(r18)
.else
        fst.l $prb, AT_$p+4(r18)
.endif
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
.if FIELD & !BINNED
$prc    = add.dd $prb, $pub
        fst.l $prc, AT_$p+4(r18)
.else
        fst.l $prb, AT_$p+4(r18)
.endif
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
.if PHONG
        // Store the instruction heads, and load the colour of the first corner.
colour  = ld.l R_COLOUR(r3)
.else
        // Store the instruction heads.
.endif
        st.l r24, 0(r18)
        st.l r25, 4(r18)
        st.l r25, 20(r18)
        st.l r25, 36(r18)
h2      = ld.l P_HEADS+8(r20)
        st.l h2, 52(r18)
h3      = ld.l P_HEADS+12(r20)
        st.l h3, 68(r18)
h4      = ld.l P_HEADS+16(r20)
        st.l h4, 72(r18)
h5      = ld.l P_HEADS+20(r20)
        st.l h5, 88(r18)
h6      = ld.l P_HEADS+24(r20)
        st.l h6, 104(r18)
.if PHONG
h7      = ld.l P_HEADS+28(r20)
        st.l h7, 120(r18)
        st.l colour, 124(r18)
.endif
.if BINNED & !FIELD
        // r22 is not 0 if more tests are necessary: corners in doubt, no area, no pixel, or more than one region.
        // Otherwise, r23 is the place of the region's bin in the table, and r7 the end of the bin.
lxb     = ld.l LOW_XY(r2) !low
lyb     = ld.l LOW_XY+4(r2) !low
ga      = subs lxb, bias8
gb      = subs lyb, bias8
hxb     = ld.l HIGH_XY(r2) !high
hyb     = ld.l HIGH_XY+4(r2) !high
past    = adds 15, bias
gi      = subs past, hxb
gk      = subs past, hyb
.if GRID
lastx2  = ld.l P_LAST_X(r20)
gc      = subs lastx2, gi
lasty2  = ld.l P_LAST_Y(r20)
gd      = subs lasty2, gk
.else
gc      = subs 10239, gi
gd      = subs 7679, gk
.endif
ge      = or ga, gb
gf      = or gc, gd
gg      = or ge, gf
gh      = or gg, doubt
column  = shra 11, ga
gj      = shra 11, gi
row     = shra 11, gb
gl      = shra 11, gk
gm      = xor column, gj
gn      = xor row, gl
go      = or gm, gn
        // The last pixel before the high side, times 16, minus the low side.
hx_l    = andnot 15, gi
hx_m    = adds -16, hx_l
gp      = subs hx_m, ga
hy_l    = andnot 15, gk
hy_m    = adds -16, hy_l
gq      = subs hy_m, gb
gr      = or gp, gq
gs      = or gr, gh
gt      = shr 31, gs
r22     = or gt, go
.if GRID
        // The row times the number of regions across, as floating-point numbers with integer values.
across  = ld.l P_COLUMNS(r20)
ca      = adds across, bias
cb      = ixfr ca
rounds2 = fld.l P_ROUND_S(r20)
cc_f    = sub.ss cb, rounds2
ra_i    = adds row, bias
ra_f    = ixfr ra_i
ra_w    = sub.ss ra_f, rounds2
ra_n    = mul.ss ra_w, cc_f
ra_b    = add.ss ra_n, rounds2
@place  fst.l ra_b, ROW_WORD(r2)
ia      = ld.l ROW_WORD(r2) !place
ib      = subs ia, bias
.else
ia      = shl 2, row
ib      = adds ia, row
.endif
ic      = adds ib, column
.if GRID
id      = and 127, ic
.else
id      = and 31, ic
.endif
ie      = shl 2, id
entry   = adds ie, r19
r23     = or r0, entry
r7      = ld.l 0(entry)
.else
        // r22 is not 0 if more tests are necessary: corners in doubt or near the guard band, or no area. Bins, if any,
        // are made later.
guard   = or 55264, r0
leastw  = subs bias, guard
leastv  = adds 8, leastw
lxb     = ld.l LOW_XY(r2) !low
lyb     = ld.l LOW_XY+4(r2) !low
hxb     = ld.l HIGH_XY(r2) !high
hyb     = ld.l HIGH_XY+4(r2) !high
ga      = subs lxb, leastw
gb      = subs lyb, leastw
gc      = subs hxb, leastv
gd      = subs hyb, leastv
ge      = or ga, gb
gf      = or gc, gd
gg      = or ge, gf
gh      = or gg, doubt
r22     = shr 31, gh
.if BOXES
        // The box is stored at r19.
keptlx  = subs lxb, bias
keptly  = subs lyb, bias
kepthx  = subs bias8, hxb
kepthy  = subs bias8, hyb
        st.l keptlx, 0(r19)
        st.l kepthx, 4(r19)
        st.l keptly, 8(r19)
        st.l kepthy, 12(r19)
.endif
.endif
        .endlinear
.if BINNED & FIELD
        .macro  restated_after
        restate
        .endm
        d.fnop
            br      slow
        d.fnop
            nop
.elseif BINNED
        .macro  restated_after
        .endm
        d.fnop
            btne    r22, r0, slow
        d.fnop
            st.l    r18, 0(r7)
        d.fnop
            adds    4, r7, r7
        d.fnop
            st.l    r7, 0(r23)
.elseif BOXES
        .macro  restated_after
        .endm
        d.fnop
            btne    r22, r0, slow
        d.fnop
            adds    16, r19, r19
.else
        .macro  restated_after
        .endm
        d.fnop
            btne    r22, r0, slow
.endif
        d.fnop
            adds    COMMAND_BYTES, r18, r18
passed: d.fnop
            adds    LIST_STEP, r16, r16
        d.fnop
            adds    RECORD_STEP, r3, r3
        d.fnop
            adds    RECORD_STEP, r4, r4
        d.fnop
            adds    -1, r31, r31
        d.fnop
            adds    RECORD_STEP, r5, r5
        d.fnop
            btne    r0, r31, triangles
        fnop
            nop
        fnop
            nop
finished: nexteye
        btne    r0, r17, batch
        ld.l    SAVE(r2), r1
        nop
        bri     r1
        nop

// ---- out of the loop: leave dual-instruction mode
        .align  8
slow:   fnop
            nop
        fnop
            st.l    r31, LEFT(r2)
        doubtful r8
        nop
        subs    r8, r0, r0
        bc      doubt                       // the words are negative
        call    box
        nop
        safe    r7                          // inside the guard band?
        adds    r7, r24, r8
        adds    r7, r26, r9
        subs    r7, r25, r10
        subs    r7, r27, r11
        or      r8, r9, r8
        or      r10, r11, r10
        or      r8, r10, r8
        subs    r8, r0, r0
        bnc     accepted
        ld.l    P_CLIPPER(r20), r7
        nop
        calli   r7
        nop
        btne    r0, r22, drop
        ld.l    BOX(r2), r24
        ld.l    BOX+4(r2), r25
        ld.l    BOX+8(r2), r26
        ld.l    BOX+12(r2), r27
accepted: ld.l  AREA_WORD+4(r2), r22
        nop
        shl     1, r22, r22
        bte     r0, r22, drop                // nothing to draw
        facing  AREA_WORD+4, drop
        call    bins
        nop
        bte     r0, r22, drop               // no region
        restated_after
        adds    COMMAND_BYTES, r18, r18
drop:   ld.l    LEFT(r2), r31
        adds    LIST_STEP, r16, r16
        adds    -1, r31, r31
        adds    RECORD_STEP, r3, r3
        bte     r0, r31, finished
        br      more
        nop

// The box as integers.
box:    orh     0x4B40, r0, r7
        ld.l    LOW_XY(r2), r24
        ld.l    LOW_XY+4(r2), r26
        ld.l    HIGH_XY(r2), r25
        ld.l    HIGH_XY+4(r2), r27
        subs    r24, r7, r24
        subs    r26, r7, r26
        adds    8, r7, r7
        subs    r7, r25, r25
        subs    r7, r27, r27
        st.l    r24, BOX(r2)
        st.l    r25, BOX+4(r2)
        st.l    r26, BOX+8(r2)
        st.l    r27, BOX+12(r2)
        bri     r1
        nop
