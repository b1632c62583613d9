(expect: modal-conflict 3:5)
G51.1 X0
G91 G28 Z0
