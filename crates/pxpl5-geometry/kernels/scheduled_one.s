// A batch is done when both loops have been gone through once, for one eye.

        .macro  lefteye
        .endm
        .macro  batchnoted
        .endm
        .macro  nexteye
        .endm
