// Dual-instruction code: the end of the loop over corners.

        // The corner must not be so far outside the picture that the words lose their order.
        for i 0 1 2
qa$i    = ld.l RECORD*$i+R_SNAPPED(r6) !xi$i
qb$i    = ld.l RECORD*$i+R_TURNED(r6) !xj$i
qc$i    = or qa$i, qb$i
qd$i    = ld.l RECORD*$i+R_SNAPPED+4(r6) !yi$i
qe$i    = ld.l RECORD*$i+R_TURNED+4(r6) !yj$i
qf$i    = or qd$i, qe$i
qg$i    = or qc$i, qf$i
qh$i    = ld.l SCRATCH+16*$i(r2) !fh$i
qi$i    = or qg$i, qh$i
        endfor
.if STRIPS
        for i 0 1 2
        st.l qi$i, RECORD*$i+R_DOUBT(r6)
begins$i = ld.l 32*$i+BEGINS(r29)
        st.l begins$i, RECORD*$i+R_BEGINS(r6)
        endfor
.else
qj      = or qi0, qi1
qk      = or qj, qi2
        st.l qk, R_DOUBT(r6)
.endif
        .endlinear
