// A command: enable; three edges; depth compared, depth loaded again; normal x, y, z; the object's colour.
COMMAND_BYTES = 128

// The colour of the triangle's first corner, and its instruction head
        .macro  finish
        ld.l    P_HEADS+28(r20), r10
        ld.l    COLOUR(r16), r11
        st.l    r10, 120(r18)
        st.l    r11, 124(r18)
        .endm
