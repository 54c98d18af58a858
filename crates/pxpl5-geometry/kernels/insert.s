// Puts the command at r18 into the bin of a region: table of bins r19, entries made r22. Changes r28, r29.
        .macro  insert region
        shl     2, \region, r28
        ld.l    r28(r19), r29
        adds    r28, r19, r28
        adds    1, r22, r22
        st.l    r18, 0(r29)
        adds    4, r29, r29
        st.l    r29, 0(r28)
        .endm
