        // r22 is not 0 where more must be asked: corners in doubt or near the guard band, no area; bins, if any, are made afterwards
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
