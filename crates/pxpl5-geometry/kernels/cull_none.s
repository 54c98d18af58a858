// Triangles are drawn whichever way they face.

        .macro  facing at, otherwise
        .endm
        .macro  facing_float high, otherwise
        .endm
