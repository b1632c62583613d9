(expect: out-of-range 2:10)
G68.2 P1 Q122 X0 Y0 Z0 I10
