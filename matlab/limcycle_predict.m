function result = limcycle_predict (what, varargin)
% LIMCYCLE_PREDICT  Every limit cycle of a loop, predicted and checked in the time domain.
%   RESULT = LIMCYCLE_PREDICT (CASE, NAME, VALUE, ...): see LIMCYCLE.
  result = limcycle ('predict', what, varargin{:});
end
