        // two lines of the frame are one of the field
        for k 0 1 2
wd$k    = add.ss ex$k, ex$k
wb$k    = add.sd round52, wd$k
        fst.l wb$k, 16*$k+12(r18)
        endfor
