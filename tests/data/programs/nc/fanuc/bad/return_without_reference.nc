(expect: no-reference 2:5)
G29 X1
