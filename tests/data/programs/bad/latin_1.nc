(expect: not-text 5:4)
G17 G21 G54 G90
T1 M6
S12000 M3
(Fläche)
M30
