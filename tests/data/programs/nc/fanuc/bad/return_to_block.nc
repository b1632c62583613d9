(expect: unknown-label 5:1)
M98 P1
M30
O0001
M99 P10
