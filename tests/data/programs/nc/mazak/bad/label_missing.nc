(expect: unknown-label 2:1)
M98 P5 Q7
M30
O5
M99
