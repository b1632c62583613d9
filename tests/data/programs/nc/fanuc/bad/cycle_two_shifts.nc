(expect: modal-conflict 2:1)
G76 X1 Z-5 R2 Q1 I1 F100
M30
