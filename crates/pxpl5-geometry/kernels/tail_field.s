        d.fnop
            br      slow
        d.fnop
            nop
