        .macro  restated_after
        restate
        .endm
        d.fnop
            br      slow
        d.fnop
            nop
