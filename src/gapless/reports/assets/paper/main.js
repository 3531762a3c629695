// The page of a paper is words, tables and pictures: only the colours move.
setTheme("");
