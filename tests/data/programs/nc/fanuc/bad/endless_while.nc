(expect: endless-loop 3:1)
WHILE [1 EQ 1] DO1
END1
