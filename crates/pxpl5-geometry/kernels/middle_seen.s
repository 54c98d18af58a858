        // the pixel of reference: the middle of what is seen of the box; where nothing is, there will be no command
lx_p    = shra 31, lx
lx_u    = andnot lx_p, lx
ly_p    = shra 31, ly
ly_u    = andnot ly_p, ly
hx_r    = subs 10239, hx
hx_s    = shra 31, hx_r
hx_t    = and hx_s, hx_r
hx_u    = adds hx_t, hx
hy_r    = subs 7679, hy
hy_s    = shra 31, hy_r
hy_t    = and hy_s, hy_r
hy_u    = adds hy_t, hy
rxa     = adds lx_u, hx_u
rx      = shra 5, rxa
rya     = adds ly_u, hy_u
ry      = shra 5, rya
