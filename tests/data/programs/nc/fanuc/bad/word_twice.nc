(expect: word-twice 2:8)
G00 X1 X2
