// For a pipeline that sends every triangle to all regions: there are no bins.

bins:   bri     r1
        mov     1, r22
