        // the box goes to r19
keptlx  = subs lxb, bias
keptly  = subs lyb, bias
kepthx  = subs bias8, hxb
kepthy  = subs bias8, hyb
        st.l keptlx, 0(r19)
        st.l kepthx, 4(r19)
        st.l keptly, 8(r19)
        st.l kepthy, 12(r19)
