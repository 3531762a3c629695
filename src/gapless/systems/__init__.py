"""Systems: recipes, the decisions they need from the data, and the navigators built from both."""
