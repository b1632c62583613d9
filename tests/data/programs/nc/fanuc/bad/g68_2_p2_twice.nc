(expect: word-twice 3:10)
G68.2 P2 Q1 X1
G68.2 P2 Q1 X2
