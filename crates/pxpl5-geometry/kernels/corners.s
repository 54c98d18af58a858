        // corners in clockwise order
bb      = fld.d R_SNAPPED(second)
cc      = fld.d R_SNAPPED(third)
ex0     = sub.ss bb.0, a.0
ey0     = sub.ss bb.1, a.1
ex2     = sub.ss a.0, cc.0
ey2     = sub.ss a.1, cc.1
ex1     = sub.ss cc.0, bb.0
ey1     = sub.ss cc.1, bb.1
        // 16 / area goes on
rd      = mul.dd ac, rc
re      = sub.dd two, rd
rf      = mul.dd rc, re
rg      = mul.dd ac, rf
rh      = sub.dd two, rg
ri      = mul.dd rf, rh
