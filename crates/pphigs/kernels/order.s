// An order put together (order_rules.md).
//
// In: r16 where it goes, r17 what it says, r18 words of that (at least 1), r19 its views, r20 words of these.

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
