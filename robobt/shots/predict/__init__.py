"""Shot predictors: training, cross-validation, export."""
