        // the pixel of reference: the middle of what is in the picture of the box, or its nearest side
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
