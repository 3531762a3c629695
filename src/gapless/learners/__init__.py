"""Learners of the papers, as scikit-learn estimators; one method a file."""
