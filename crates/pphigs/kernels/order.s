// Assembles an order, the message with which the master gives work to a slave (order_rules.md). The code copies the first
// words of the order, then the words of the views.
//
// In: r16 destination, r17 first words of the order, r18 their number (at least 1), r19 words of the views, r20 their
// number.

        .align  32
order:  ld.l    0(r17), r21
        adds    4, r17, r17
        adds    -1, r18, r18
        st.l    r21, 0(r16)
        adds    4, r16, r16
        btne    r0, r18, order
        bte     r0, r20, complete
views:  ld.l    0(r19), r21
        adds    4, r19, r19
        adds    -1, r20, r20
        st.l    r21, 0(r16)
        adds    4, r16, r16
        btne    r0, r20, views
complete: bri   r1
        nop
