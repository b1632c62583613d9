(expect: unknown-tool 2:5)
G43 H9 Z10
