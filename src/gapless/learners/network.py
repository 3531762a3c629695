"""The feed-forward network of aslinezhad2020: scikit-learn's, as small as the paper's data allow."""

from __future__ import annotations

from typing import Any

from sklearn.neural_network import MLPRegressor


def mlp() -> Any:
    """One hidden layer of 20 tanh nodes, trained as a whole by L-BFGS.

    The paper names neither layer nor method ("back-propagation"). On some hundred samples a
    quasi-Newton method needs no learning rate and gives the same result whatever their order.
    `max_iter` is the budget: a fit that reaches it warns and keeps what it has.

    Returns
    -------
    sklearn.neural_network.MLPRegressor
    """
    return MLPRegressor(
        hidden_layer_sizes=(20,), activation="tanh", solver="lbfgs", alpha=1e-3, max_iter=500, tol=1e-6
    )
