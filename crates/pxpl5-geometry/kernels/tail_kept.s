        .macro  restated_after
        .endm
        d.fnop
            btne    r22, r0, slow
        d.fnop
            adds    16, r19, r19
