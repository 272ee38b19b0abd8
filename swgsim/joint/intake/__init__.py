"""Reading of joint recordings: files of any maker through a column map (a source), with checks."""
