(expect: recursion-limit 5:1)
M98 P1
M30
O0001
M98 P1
M99
