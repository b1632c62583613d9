(expect: not-at-reference 3:5)
G00 Z5
G27 X1
