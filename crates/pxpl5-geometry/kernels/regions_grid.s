        // r22 is not 0 where more must be asked: corners in doubt, no area, no pixel, not in one region alone;
        // else r23 is the place of the region's bin in the table, r7 its end
lxb     = ld.l LOW_XY(r2) !low
lyb     = ld.l LOW_XY+4(r2) !low
ga      = subs lxb, bias8
gb      = subs lyb, bias8
hxb     = ld.l HIGH_XY(r2) !high
hyb     = ld.l HIGH_XY+4(r2) !high
past    = adds 15, bias
gi      = subs past, hxb
gk      = subs past, hyb
lastx2  = ld.l P_LAST_X(r20)
gc      = subs lastx2, gi
lasty2  = ld.l P_LAST_Y(r20)
gd      = subs lasty2, gk
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
        // the last pixel before the high side, times 16, less what is before the low side
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
        // the row times the regions across, as floats that are whole
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
ic      = adds ib, column
id      = and 127, ic
ie      = shl 2, id
entry   = adds ie, r19
r23     = or r0, entry
r7      = ld.l 0(entry)
