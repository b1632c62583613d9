(expect: modal-conflict 3:1)
G68 X0 Y0 R30
G51.1 X0
