        for k 0 1 2
wb$k    = add.sd round52, ex$k
        fst.l wb$k, 16*$k+12(r18)
        endfor
