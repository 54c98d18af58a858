// What is kept of a triangle between two views.
E_INSIDE  = 0       // not 0 where all corners are inside the guard band of both
E_TOP     = 4       // the least and the greatest y of the corners in both, 1/16 px of the frame
E_BOTTOM  = 8
E_CORNERS = 16      // of each corner in the first view: x and y, single; depth, double, at:
E_DEPTH   = 8
E_CORNER  = 16
E_VIEW    = 48      // the same in the second view, behind them
E_BYTES   = 112
