// Surfaces of precomputed colours: those of the corners, 0 to 255 in units of 1/4096, and half a unit.

// A command: enable; three edges; depth compared, depth loaded again; red, green, blue.
COMMAND_BYTES = 120

// Nothing follows the planes.
        .macro  finish triangle
        .endm

        .macro  leave shift, colour, at
        shr     \shift, \colour, r11
        and     255, r11, r11
        shl     12, r11, r11
        or      2048, r11, r11
        st.l    r11, \at(r6)
        .endm

        .macro  component k
        leave   16-8*\k, r7, SURFACE_WORD*\k
        leave   16-8*\k, r8, SURFACE_WORD*\k+SURFACE_CORNER
        leave   16-8*\k, r9, SURFACE_WORD*\k+2*SURFACE_CORNER
        .endm

// In: r5 triangle, r6 where the words go. Changes r7 to r9 and r11.
        .align  32
surface: ld.l   COLOUR(r5), r7
        ld.l    COLOUR+32(r5), r8
        ld.l    COLOUR+64(r5), r9
        component 0
        component 1
        component 2
        bri     r1
        nop
