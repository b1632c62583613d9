(expect: word-twice 2:4)
T1 T2 M06
M30
