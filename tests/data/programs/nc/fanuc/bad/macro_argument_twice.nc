(expect: word-twice 2:15)
G65 P10 A1 B2 B3
M30
O0010
M99
