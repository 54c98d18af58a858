        for i 0 1 2
nx$i     = fld.l 32*$i+NORMAL(r29)
ga$i    = mul.ss x$i, nx$i
        endfor
        for i 0 1 2
ny$i     = fld.l 32*$i+NORMAL+4(r29)
gb$i    = mul.ss y$i, ny$i
        endfor
        for i 0 1 2
nz$i     = fld.l 32*$i+NORMAL+8(r29)
gc$i    = mul.ss z$i, nz$i
gd$i    = add.ss ga$i, gb$i
        endfor
        for i 0 1 2
ge$i    = add.ss gd$i, gc$i
        endfor
