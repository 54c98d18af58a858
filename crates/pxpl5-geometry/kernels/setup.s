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
        // the box: the least of the corners, and of what is left of them to 8
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
