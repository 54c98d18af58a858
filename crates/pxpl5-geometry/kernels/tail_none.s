        .macro  restated_after
        .endm
        d.fnop
            btne    r22, r0, slow
