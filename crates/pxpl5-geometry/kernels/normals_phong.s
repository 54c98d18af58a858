        // the normal in eye coordinates
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
