(expect: unsupported-word 2:5)
G91 G51.1 X0
