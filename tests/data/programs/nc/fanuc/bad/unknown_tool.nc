(expect: unknown-tool 2:1)
T99 M06
